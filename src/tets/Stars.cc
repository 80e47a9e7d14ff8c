/// @file Stars.cc
/// The tables, from those of the lattice.
#include "tets/Stars.h"

namespace vdbtet {

const std::array<std::array<Stars::Kin, 24>, 2> Stars::kKin = Stars::makeKin();
const std::array<std::array<Stars::Role, 18>, 2> Stars::kRoles = Stars::makeRoles();

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

std::array<std::array<Stars::Role, 18>, 2> Stars::makeRoles() {
    std::array<std::array<Role, 18>, 2> all{};
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        std::size_t next = 0;
        for (const bcc::Lattice spine : {bcc::A, bcc::B}) {
            for (int axis = 0; axis < 3; ++axis) {
                const LocalOctahedron octahedron = localOctahedron(spine, axis, localIndex(spine, 3, 3, 3));
                for (int vertex = 0; vertex < 6; ++vertex) {
                    if (latticeOf(octahedron[vertex]) == lattice)
                        all[lattice][next++] = {spine, axis, octahedron[0] - octahedron[vertex], vertex};
                }
            }
        }
    }
    return all;
}

void Stars::load(const Neighbours& neighbours, const LocalStates& states) {
    mStates = &states;
    mLocalFlips.load(mFlips, neighbours);
    mAnyFlips = false;
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        for (int axis = 0; axis < 3; ++axis) mAnyFlips = mAnyFlips || mLocalFlips.mask(lattice, axis).any();
    }
}

} // namespace vdbtet
