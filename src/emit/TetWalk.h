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
    TetWalk(const TetWalk&) = delete;
    TetWalk& operator=(const TetWalk&) = delete;

    /// Go to a surface tile; its tets and local vertices are at hand until the next call.
    void load(TileRef tile);

    const LocalVertices& local() const { return mLocal; }

    /// @brief Call @a visit(LocalTet, manifoldVertices) for each tet in the mesh.
    /// @return the number of ambiguous tets, which are not in the mesh
    template <typename Visit>
    std::int64_t forEachTet(Visit&& visit) const;

    /// @return the slice of the octahedron of the spine along the positive @a axis from the vertex @a lower,
    /// a local number.
    bcc::Slice slice(int axis, int lower) const { return mSlices[axis][lower]; }

    /// @return the state of the vertex (x,y,z) of @a lattice, each coordinate in -8..15.
    State stateAt(int lattice, int x, int y, int z) const;

private:
    /// @return L_A spines whose octahedra have a vertex in the interior or both ends manifold; no other can
    /// hold a tet of the mesh or an ambiguous one. @a plain receives those with all six vertices in the
    /// interior.
    TileMask relevantSpines(int axis, TileMask& plain) const;

    bool ringEdgeFlipped(const LocalTet& tet, int axis) const {
        const bcc::RingEdge& edge = bcc::kRingEdges[tet.number];
        return slice((axis + edge.axisOffset) % 3, tet.octahedron[edge.lower]) != bcc::S;
    }

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
    std::array<std::array<bcc::Slice, kLocalVertices>, 3> mSlices{}; ///< by axis and lower end
    std::vector<bcc::Slice*> mFlipped;                               ///< those that are not S
};

template <typename Visit>
std::int64_t TetWalk::forEachTet(Visit&& visit) const {
    std::int64_t ambiguous = 0;
    LocalTet tet;
    tet.lattice = bcc::A;
    for (int axis = 0; axis < 3; ++axis) {
        TileMask plain;
        relevantSpines(axis, plain).forEach([&](int n) {
            const int base = localIndex(bcc::A, n);
            tet.octahedron = localOctahedron(bcc::A, axis, base);
            tet.slice = slice(axis, base);
            const bool isPlain = plain.test(n);
            for (tet.number = 0; tet.number < 4; ++tet.number) {
                if (isPlain) {
                    visit(tet, 0);
                } else if (tet.slice != bcc::S || !ringEdgeFlipped(tet, axis)) {
                    ambiguous += classify(tet, visit);
                }
            }
        });
    }
    tet.lattice = bcc::B;
    mFlips.forEach(mTile, [&](const Flip& flip) {
        if (flip.lattice != bcc::B) return;
        tet.octahedron = localOctahedron(bcc::B, flip.axis, localIndex(bcc::B, flip.vertex));
        tet.slice = flip.slice;
        for (tet.number = 0; tet.number < 4; ++tet.number) ambiguous += classify(tet, visit);
    });
    return ambiguous;
}

} // namespace vdbtet
