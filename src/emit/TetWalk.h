/// @file TetWalk.h
/// Visits the tets that a surface tile owns, in the order in which they are written.
///
/// A tile owns the octahedra of its L_A spines and the flipped octahedra of its L_B spines. The unflipped L_A
/// octahedra less what the flipped L_B ones take away, and the flipped ones of both, make up space.
#pragma once

#include "destinations/LocalVertices.h"
#include "flips/Flips.h"

#include <cstdint>

namespace vdbtet {

/// A tet of the mesh as part of an octahedron.
struct LocalTet {
    LocalOctahedron octahedron;
    bcc::Lattice lattice; ///< of the spine
    bcc::Slice slice;
    int number; ///< in kSliceTets[slice]

    int vertex(int i) const { return octahedron[bcc::kSliceTets[slice][number][i]]; }
};

class TetWalk {
public:
    TetWalk(const Vertices& vertices, const Flips& flips) : mVertices(vertices), mFlips(flips) {}

    /// Go to a surface tile; its tets and local vertices are at hand until the next call.
    void load(TileRef tile);

    const LocalVertices& local() const { return mLocal; }
    const Neighbours& neighbours() const { return *mNeighbours; }

    /// @brief Call @a visit(LocalTet, manifoldVertices) for each tet in the mesh.
    /// @return the number of ambiguous tets, which are not in the mesh
    template <typename Visit>
    std::int64_t forEachTet(Visit&& visit) const;

    /// @return the slice of the octahedron of the spine at the vertex (x,y,z) of @a lattice, each coordinate
    /// in -8..15.
    bcc::Slice slice(int lattice, int axis, int x, int y, int z) const;

    /// @return the state of the vertex (x,y,z) of @a lattice, each coordinate in -8..15.
    State stateAt(int lattice, int x, int y, int z) const;

private:
    /// @return L_A spines whose octahedra have a vertex in the interior or both ends manifold; no other can
    /// hold a tet of the mesh or an ambiguous one. @a plain receives those with all six vertices in the
    /// interior.
    TileMask relevantSpines(int axis, TileMask& plain) const;

    bool ringEdgeFlipped(int axis, int base, int number) const;

    template <typename Visit>
    std::int64_t classify(const LocalTet& tet, Visit&& visit) const {
        int manifold = 0;
        for (int i = 0; i < 4; ++i) {
            const State state = mLocal.state(tet.vertex(i));
            if (state == State::Outside) return 0;
            manifold += state == State::Manifold;
        }
        if (manifold == 4) return 1;
        visit(tet, manifold);
        return 0;
    }

    Vertices mVertices;
    const Flips& mFlips;
    LocalVertices mLocal;
    TileRef mTile = 0;
    const Neighbours* mNeighbours = nullptr;
    bool mAnyFlipsB = false; ///< some L_B spine of the tile or a neighbour is flipped
};

template <typename Visit>
std::int64_t TetWalk::forEachTet(Visit&& visit) const {
    std::int64_t ambiguous = 0;
    const TileFlips& flips = mFlips.tiles[mTile];
    LocalTet tet;
    tet.lattice = bcc::A;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& flipped = flips[bcc::A][axis];
        TileMask plain;
        relevantSpines(axis, plain).forEach([&](int n) {
            const int base = localIndex(bcc::A, n);
            tet.octahedron = localOctahedron(bcc::A, axis, base);
            tet.slice = flipped[0].test(n) ? bcc::SliceA : flipped[1].test(n) ? bcc::SliceB : bcc::S;
            if (plain.test(n)) {
                for (tet.number = 0; tet.number < 4; ++tet.number) visit(tet, 0);
                return;
            }
            for (tet.number = 0; tet.number < 4; ++tet.number) {
                if (tet.slice == bcc::S && mAnyFlipsB && ringEdgeFlipped(axis, base, tet.number)) continue;
                ambiguous += classify(tet, visit);
            }
        });
    }
    tet.lattice = bcc::B;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& flipped = flips[bcc::B][axis];
        (flipped[0] | flipped[1]).forEach([&](int n) {
            tet.octahedron = localOctahedron(bcc::B, axis, localIndex(bcc::B, n));
            tet.slice = flipped[0].test(n) ? bcc::SliceA : bcc::SliceB;
            for (tet.number = 0; tet.number < 4; ++tet.number) ambiguous += classify(tet, visit);
        });
    }
    return ambiguous;
}

} // namespace vdbtet
