/// @file Stars.cc
/// The tables, from those of the lattice.
#include "tets/Stars.h"

namespace vdbtet {

const std::array<std::array<Stars::Kin, 24>, 2> Stars::kKin = Stars::makeKin();
const std::array<std::array<Stars::Role, kRoles>, 2> Stars::kOctahedraOf = Stars::makeRoles();

std::array<std::array<Stars::Kin, 24>, 2> Stars::makeKin() {
    std::array<std::array<Kin, 24>, 2> all{};
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        const int v = localIndex(lattice, 3, 3, 3); // any vertex well inside a tile
        std::size_t next = 0;
        for (int axis = 0; axis < 3; ++axis) {
            for (const int end : {0, 1}) { // v's number in the octahedron
                const int lower = v - end * PaddedMask::step(axis == 0, axis == 1, axis == 2);
                const LocalOctahedron octahedron = localOctahedron(lattice, axis, lower);
                for (int number = 0; number < 4; ++number) {
                    const bcc::RingEdge& ring = bcc::kRingEdges[number];
                    Kin kin{};
                    kin.spine = lower - v;
                    kin.spineAxis = axis;
                    kin.ring = octahedron[ring.lower] - v;
                    kin.ringAxis = (axis + ring.axisOffset) % 3;
                    for (int i = 0; i < 4; ++i)
                        kin.vertices[i] = octahedron[bcc::kSliceTets[bcc::S][number][i]] - v;
                    kin.spineRole = kRolesOf[lattice][std::size_t(axis)][std::size_t(end)];
                    const LocalOctahedron about =
                        localOctahedron(bcc::other(lattice), kin.ringAxis, v + kin.ring);
                    const auto place = std::find(about.begin(), about.end(), v) - about.begin();
                    kin.ringRole =
                        kRolesOf[bcc::other(lattice)][std::size_t(kin.ringAxis)][std::size_t(place)];
                    kin.number = number;
                    if (lattice == bcc::B) {
                        const LocalOctahedron owner = localOctahedron(bcc::A, kin.ringAxis, v + kin.ring);
                        for (int n = 0; n < 4; ++n) {
                            const bcc::RingEdge& edge = bcc::kRingEdges[n];
                            if (owner[edge.lower] == lower && (kin.ringAxis + edge.axisOffset) % 3 == axis)
                                kin.number = n;
                        }
                    }
                    all[lattice][next++] = kin;
                }
            }
        }
    }
    return all;
}

std::array<std::array<Stars::Role, kRoles>, 2> Stars::makeRoles() {
    std::array<std::array<Role, kRoles>, 2> all{};
    for (const bcc::Lattice spine : {bcc::A, bcc::B}) {
        for (int axis = 0; axis < 3; ++axis) {
            const LocalOctahedron octahedron = localOctahedron(spine, axis, localIndex(spine, 3, 3, 3));
            for (std::size_t i = 0; i < 6; ++i) {
                const auto role = std::size_t(kRolesOf[spine][std::size_t(axis)][i]);
                all[latticeOf(octahedron[i])][role] = {spine, axis, octahedron[0] - octahedron[i], int(i)};
            }
        }
    }
    return all;
}

void Stars::load(TileRef tile, const LocalStates& states) {
    const Neighbours& neighbours = mVertices.layout.neighbours[tile];
    mStates = &states;
    mChanged.clear();
    for (int slot = 0; slot < 27; ++slot) {
        const TileChanges* changes = mVertices.changesOf(neighbours[slot]);
        if (!changes) continue;
        const int shift = PaddedMask::step(8 * (slot / 9 - 1), 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1));
        for (const TetCode code : changes->tets) {
            if (!borderOf(slot).test(tetBit(code))) continue;
            const auto lattice = bcc::Lattice(tetLattice(code));
            mChanged.push_back(
                keyOf({lattice, tetAxis(code), tetNumber(code), localIndex(lattice, tetBit(code)) + shift}));
        }
    }
    std::sort(mChanged.begin(), mChanged.end());
    for (const int v : mAtFlips) mSlices[std::size_t(v)] = 0;
    mAtFlips.clear();
    for (int slot = 0; slot < 27; ++slot) {
        if (neighbours[slot] < 0) continue;
        const TileMask& border = borderOf(slot);
        const int dx = 8 * (slot / 9 - 1), dy = 8 * (slot / 3 % 3 - 1), dz = 8 * (slot % 3 - 1);
        mFlips.forEach(neighbours[slot], [&](const Flip& flip) {
            if (!border.test(flip.vertex)) return;
            const auto& roles = kRolesOf[flip.lattice][std::size_t(flip.axis)];
            for (std::size_t i = 0; i < 6; ++i) {
                const bcc::Vertex& at = bcc::kOctahedra[flip.lattice][flip.axis][i];
                const int x = (flip.vertex >> 6) + dx + at.x, y = (flip.vertex >> 3 & 7) + dy + at.y,
                          z = (flip.vertex & 7) + dz + at.z;
                if (((x | y | z) & ~7) != 0) continue;
                const int v = localIndex(at.lattice, x, y, z);
                mSlices[std::size_t(v)] |= std::uint64_t(flip.slice) << (2 * roles[i]);
                mAtFlips.push_back(v);
            }
        });
    }
}

} // namespace vdbtet
