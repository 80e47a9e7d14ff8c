/// @file BoundaryFaces.cc
/// By masks where the octahedron beyond is not flipped, else one face at a time.
#include "tets/BoundaryFaces.h"

#include <algorithm>
#include <set>

namespace vdbtet {

namespace {

/// A vertex in doubled coordinates: L_A even, L_B odd.
struct Doubled {
    int c[3];

    explicit constexpr Doubled(const bcc::Vertex& v)
        : c{2 * v.x + v.lattice, 2 * v.y + v.lattice, 2 * v.z + v.lattice} {}
    explicit Doubled(int local)
        : Doubled(bcc::Vertex{latticeOf(local), PaddedMask::x(bitOf(local)), PaddedMask::y(bitOf(local)),
                              PaddedMask::z(bitOf(local))}) {}
    constexpr Doubled(const Doubled& a, const Doubled& b, const Doubled& minus)
        : c{a.c[0] + b.c[0] - minus.c[0], a.c[1] + b.c[1] - minus.c[1], a.c[2] + b.c[2] - minus.c[2]} {}

    constexpr bcc::Lattice lattice() const { return bcc::Lattice(c[0] & 1); }
    constexpr int x() const { return c[0] >> 1; }
    constexpr int y() const { return c[1] >> 1; }
    constexpr int z() const { return c[2] >> 1; }
};

/// A spine by its lower end.
struct Spine {
    Doubled lower;
    int axis;
};

constexpr Spine spineBetween(const Doubled& a, const Doubled& b) {
    int axis = 0;
    while (a.c[axis] == b.c[axis]) ++axis;
    return {a.c[axis] < b.c[axis] ? a : b, axis};
}

/// The faces of a tile's tets, one at a time.
class Faces {
public:
    Faces(const Vertices& vertices, TileRef tile, const LocalFlips& flips, const LocalStates& states)
        : mVertices(vertices), mNeighbours(vertices.layout.neighbours[tile]), mFlips(flips), mStates(states) {
    }

    /// @return whether the face of three manifold vertices of a tet in the mesh lies on the mesh's boundary.
    bool isBoundary(const LocalTet& tet) const {
        int apex = 0;
        while (mStates.manifold(tet.vertex(apex))) ++apex;
        const auto& numbers = bcc::kSliceTets[tet.slice][tet.number];
        const auto at = [&](int number) { return Doubled(tet.octahedron[number]); };
        if (tet.slice == bcc::S) return isLatticeBoundary(numbers, apex, at);

        // A flipped tet: an end of the spine, the diagonal of the ring, and one more vertex of the ring.
        const int from = tet.slice == bcc::SliceA ? 2 : 3, to = from + 2;
        int end = -1, third = -1;
        for (int number : numbers) {
            if (number < 2)
                end = number;
            else if (number != from && number != to)
                third = number;
        }
        const int number = numbers[apex];
        if (number == end) return !interior(at(1 - end));
        if (number == third) return !interior(Doubled(at(from), at(to), at(third)));
        return !inMeshBeyond(at(end), at(1 - end), at(number == from ? to : from), at(third));
    }

private:
    template <typename At>
    bool isLatticeBoundary(const int (&numbers)[4], int apex, const At& at) const {
        // The tet is an edge of each lattice; across its face lies the octahedron of the edge without the
        // apex's other end. The vertices of kSliceTets[S] alternate between the lattices.
        const int partner = numbers[(apex + 2) % 4];
        return !inMeshBeyond(at(partner), at(numbers[apex]), at(numbers[(apex + 1) % 4]),
                             at(numbers[(apex + 3) % 4]));
    }

    /// @return whether the tet beyond an outer face of an octahedron is in the mesh.
    /// @param end       the end of the octahedron's spine in the face
    /// @param otherEnd  its other end
    /// @param o1,o2     the ring edge in the face
    /// @details Beyond lies the octahedron of the spine from @a end to the mirror image of @a otherEnd. All
    /// of the face is manifold, so the fourth vertex decides.
    bool inMeshBeyond(const Doubled& end, const Doubled& otherEnd, const Doubled& o1,
                      const Doubled& o2) const {
        const Doubled mirrored(o1, o2, otherEnd);
        const Spine spine = spineBetween(end, mirrored);
        const Doubled& lower = spine.lower;
        const bcc::Slice slice =
            mFlips.slice(spine.axis, localIndex(lower.lattice(), lower.x(), lower.y(), lower.z()));
        if (slice == bcc::S) return interior(mirrored);

        // A flipped octahedron: the fourth vertex is the far end of the ring's diagonal, which starts at o1
        // or at o2.
        const bcc::Octahedron& vertices = bcc::kOctahedra[lower.lattice()][spine.axis];
        const bcc::Vertex& diagonal = vertices[slice == bcc::SliceA ? 2 : 3];
        const bcc::Vertex& opposite = vertices[slice == bcc::SliceA ? 4 : 5];
        const auto is = [&](const bcc::Vertex& v, const Doubled& d) {
            return lower.x() + v.x == d.x() && lower.y() + v.y == d.y() && lower.z() + v.z == d.z();
        };
        const Doubled& start = is(diagonal, o1) || is(opposite, o1) ? o1 : o2;
        return interior(Doubled(end, mirrored, start));
    }

    /// Also of vertices beyond the border.
    bool interior(const Doubled& v) const {
        const TileRef tile = mNeighbours[neighbourSlot(tileStep(v.x()), tileStep(v.y()), tileStep(v.z()))];
        if (tile < 0) return tile == kInside;
        const int n = TileMask::bit(v.x() & 7, v.y() & 7, v.z() & 7);
        return mVertices.signs[tile][v.lattice()].test(n) &&
               !mVertices.labels.manifold[tile][v.lattice()].test(n);
    }

    const Vertices& mVertices;
    const Neighbours& mNeighbours;
    const LocalFlips& mFlips;
    const LocalStates& mStates;
};

TileMask shiftedTo(const PaddedMask& mask, const Doubled& at) { return mask.shifted(at.x(), at.y(), at.z()); }

} // namespace

void findBoundaryFaces(const Vertices& vertices, TileRef tile, const TileTets& tets,
                       const LocalStates& states, std::vector<LocalFace>& found) {
    found.clear();
    const Faces faces(vertices, tile, tets.flips(), states);
    for (int axis = 0; axis < 3; ++axis) {
        const LocalOctahedron o = localOctahedron(bcc::A, axis, 0);
        for (int number = 0; number < 4; ++number) {
            const auto& tet = bcc::kSliceTets[bcc::S][number];
            for (int apex = 0; apex < 4; ++apex) {
                TileMask candidates = tets.latticeTets(axis, number);
                for (int i = 0; i < 4; ++i) {
                    if (i != apex) candidates &= tets.manifold(axis, tet[i]);
                }
                if (!candidates.any()) continue;
                // Faces::isLatticeBoundary() of all candidates whose octahedron beyond is not flipped.
                const auto at = [&](int i) { return Doubled(bcc::kOctahedra[bcc::A][axis][tet[i % 4]]); };
                const Doubled mirrored(at(apex + 1), at(apex + 3), at(apex));
                const Spine beyond = spineBetween(at(apex + 2), mirrored);
                const TileMask flipped =
                    shiftedTo(tets.flips().mask(beyond.lower.lattice(), beyond.axis), beyond.lower);
                const TileMask inside = shiftedTo(states.interiorMask(mirrored.lattice()), mirrored);
                TileMask boundary = candidates & ~flipped & ~inside;
                (candidates & flipped).forEach([&](int n) {
                    const LocalOctahedron octahedron = localOctahedron(bcc::A, axis, localIndex(bcc::A, n));
                    if (faces.isBoundary({octahedron, bcc::A, bcc::S, number})) boundary.set(n);
                });
                const auto& face = bcc::kTetFaces[apex];
                boundary.forEach([&](int n) {
                    const int base = localIndex(bcc::A, n);
                    found.push_back({base + o[tet[face[0]]], base + o[tet[face[1]]], base + o[tet[face[2]]]});
                });
            }
        }
    }
    const auto addFlipped = [&](const LocalTet& tet) {
        int manifold = 0, apex = 0;
        for (int i = 0; i < 4; ++i) {
            if (states.manifold(tet.vertex(i))) {
                ++manifold;
            } else {
                apex = i;
            }
        }
        if (manifold != 3 || !faces.isBoundary(tet)) return;
        const auto& face = bcc::kTetFaces[apex];
        found.push_back({tet.vertex(face[0]), tet.vertex(face[1]), tet.vertex(face[2])});
    };
    for (int axis = 0; axis < 3; ++axis) {
        tets.flippedSpines(axis).forEach([&](int n) { tets.forEachTetOf(axis, n, addFlipped); });
    }
    tets.forEachTetOfB(addFlipped);
}

void findChangedFaces(const Vertices& vertices, TileRef tile, TileTets& tets, const LocalStates& states,
                      std::vector<LocalFace>& found) {
    findBoundaryFaces(vertices, tile, tets, states, found);
    const TileChanges* changes = vertices.changesOf(tile);
    tets.change(changes);
    if (!changes) return;
    const auto ascending = [](LocalFace face) {
        std::sort(face.begin(), face.end());
        return face;
    };
    std::set<LocalFace> gone;
    for (const LocalFace& face : changes->gone) gone.insert(ascending(face));
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const LocalFace& face) { return gone.count(ascending(face)) > 0; }),
                found.end());
    found.insert(found.end(), changes->fresh.begin(), changes->fresh.end());
}

} // namespace vdbtet
