/// @file TileTets.h
/// The tets that a surface tile owns, found by masks, in the order in which they are written.
///
/// A tile owns the octahedra of its L_A spines and the flipped octahedra of its L_B spines. The unflipped L_A
/// octahedra less what the flipped L_B ones take away, and the flipped ones of both, make up space.
#pragma once

#include "destinations/LocalVertices.h"
#include "flips/Flips.h"

#include <algorithm>
#include <cstdint>

namespace vdbtet {

/// A tet as part of an octahedron.
struct LocalTet {
    LocalOctahedron octahedron;
    bcc::Lattice lattice; ///< of the spine
    bcc::Slice slice;
    int number; ///< in kSliceTets[slice]

    int vertex(int i) const { return octahedron[bcc::kSliceTets[slice][number][i]]; }
};

/// The flipped spines of a tile and of a border of one around it.
class LocalFlips {
public:
    void clear();
    void load(const Flips& flips, const Neighbours& neighbours);

    /// The lower ends of the flipped spines along an axis.
    const PaddedMask& mask(bcc::Lattice lattice, int axis) const { return mFlipped[lattice][axis]; }

    /// @return the slice of the octahedron of the spine along the positive @a axis from the vertex @a lower,
    /// a local number.
    bcc::Slice slice(int axis, int lower) const {
        const bcc::Lattice lattice = latticeOf(lower);
        if (!mFlipped[lattice][axis].test(bitOf(lower))) return bcc::S;
        return mToB[lattice][axis].test(bitOf(lower)) ? bcc::SliceB : bcc::SliceA;
    }

private:
    PaddedMask mFlipped[2][3], mToB[2][3]; ///< by lattice and axis; mToB has those of slice B
};

/// Finds and visits the tets of one tile after another.
class TileTets {
public:
    TileTets(const Vertices& vertices, const Flips& flips) : mVertices(vertices), mFlips(flips) {}
    TileTets(const TileTets&) = delete;
    TileTets& operator=(const TileTets&) = delete;

    /// Go to a surface tile, the states of whose vertices are @a states, until the next call; or to a tile
    /// far from any, kInside, of which only some cells may exist.
    void load(TileRef tile, const LocalStates& states);

    /// Put in and take out what the tile's changes say; null for none.
    void change(const TileChanges* changes);

    std::int64_t tets() const { return mTets; }
    /// The tets of four manifold vertices, which are not in the mesh.
    std::int64_t ambiguous() const { return mAmbiguous; }
    const LocalFlips& flips() const { return mLocalFlips; }

    /// For each tet of slice S, by axis and number, the lower ends of the spines whose tet is in the mesh.
    const TileMask& latticeTets(int axis, int number) const { return mLattice[axis][number]; }

    /// The flipped octahedra of L_A spines along @a axis.
    const TileMask& flippedSpines(int axis) const { return mFlippedA[axis]; }

    /// Where the octahedron of the L_A spine along @a axis has a manifold vertex of number @a vertex.
    const TileMask& manifold(int axis, int vertex) const { return mManifold[axis][vertex]; }

    /// Call @a visit(TetCode) for each tet, in the order in which they are written.
    template <typename Visit>
    void forEachCode(Visit&& visit) const {
        const auto visitTet = [&](const LocalTet& tet) { visit(codeOf(tet)); };
        for (int axis = 0; axis < 3; ++axis) {
            someTets(axis).forEach([&](int n) {
                if (mFlippedA[axis].test(n)) return forEachTetOf(axis, n, visitTet);
                for (int number = 0; number < 4; ++number) {
                    if (mLattice[axis][number].test(n)) visit(tetCode(bcc::A, axis, number, n));
                }
            });
        }
        forEachTetOfB(visitTet);
    }

    /// The tet of that code, which the tile owns.
    LocalTet tetOf(TetCode code) const;

    /// The L_A spines along @a axis whose octahedra may have tets in the mesh.
    TileMask someTets(int axis) const {
        return mFlippedA[axis] | mLattice[axis][0] | mLattice[axis][1] | mLattice[axis][2] |
               mLattice[axis][3];
    }

    /// Call @a visit(LocalTet) for each tet of a flipped octahedron of the L_A spine from @a n along @a axis.
    template <typename Visit>
    void forEachTetOf(int axis, int n, Visit&& visit) const {
        visitFlipped(bcc::A, axis, mLocalFlips.slice(axis, localIndex(bcc::A, n)), n, visit);
    }

    /// Call @a visit(LocalTet) for each tet of the flipped octahedra of L_B spines.
    template <typename Visit>
    void forEachTetOfB(Visit&& visit) const {
        forEachFlipOfB(
            [&](const Flip& flip) { visitFlipped(bcc::B, flip.axis, flip.slice, flip.vertex, visit); });
    }

    /// Call @a visit(LocalTet) for each ambiguous tet.
    template <typename Visit>
    void forEachAmbiguous(Visit&& visit) const {
        const auto visitSome = [&](LocalTet tet) {
            int manifold = 0;
            for (int i = 0; i < 4; ++i) manifold += mStates->manifold(tet.vertex(i));
            if (manifold == 4 && !isChanged(codeOf(tet))) visit(tet);
        };
        const auto visitFour = [&](bcc::Lattice lattice, int axis, int n) {
            const int lower = localIndex(lattice, n);
            for (int number = 0; number < 4; ++number)
                visitSome(
                    {localOctahedron(lattice, axis, lower), lattice, mLocalFlips.slice(axis, lower), number});
        };
        for (int axis = 0; axis < 3; ++axis) {
            for (int number = 0; number < 4; ++number) {
                mAmbiguousOf[axis][number].forEach([&](int n) {
                    visitSome({localOctahedron(bcc::A, axis, localIndex(bcc::A, n)), bcc::A, bcc::S, number});
                });
            }
            mFlippedA[axis].forEach([&](int n) { visitFour(bcc::A, axis, n); });
        }
        forEachFlipOfB([&](const Flip& flip) { visitFour(bcc::B, flip.axis, flip.vertex); });
    }

private:
    void findLatticeTets(int axis);

    template <typename Visit>
    void forEachFlipOfB(Visit&& visit) const {
        if (mTile == kInside) return;
        mFlips.forEach(mTile, [&](const Flip& flip) {
            if (flip.lattice == bcc::B) visit(flip);
        });
    }

    static TetCode codeOf(const LocalTet& tet) {
        const int n = bitOf(tet.octahedron[0]), axis = axisOf(tet);
        return tetCode(tet.lattice, axis, tet.number,
                       TileMask::bit(PaddedMask::x(n), PaddedMask::y(n), PaddedMask::z(n)));
    }
    static int axisOf(const LocalTet& tet) {
        const int spine = tet.octahedron[1] - tet.octahedron[0];
        return spine == PaddedMask::step(1, 0, 0) ? 0 : spine == PaddedMask::step(0, 1, 0) ? 1 : 2;
    }
    bool isChanged(TetCode code) const {
        return mChanges && std::binary_search(mChanges->tets.begin(), mChanges->tets.end(), code);
    }

    /// Visit those of the four tets that are in the mesh.
    /// @return the number of ambiguous ones
    template <typename Visit>
    int visitFlipped(bcc::Lattice lattice, int axis, bcc::Slice slice, int n, Visit&& visit) const {
        LocalTet tet{localOctahedron(lattice, axis, localIndex(lattice, n)), lattice, slice, 0};
        int ambiguous = 0;
        for (tet.number = 0; tet.number < 4; ++tet.number) {
            int manifold = 0, interior = 0;
            for (int i = 0; i < 4; ++i) {
                manifold += mStates->manifold(tet.vertex(i));
                interior += mStates->interior(tet.vertex(i));
            }
            if (manifold + interior < 4) continue;
            ambiguous += manifold == 4;
            if ((manifold < 4) != isChanged(codeOf(tet))) visit(tet);
        }
        return ambiguous;
    }

    const Vertices& mVertices;
    const Flips& mFlips;
    const LocalStates* mStates = nullptr;
    const TileChanges* mChanges = nullptr;
    TileRef mTile = 0;
    LocalFlips mLocalFlips;
    TileMask mLattice[3][4], mAmbiguousOf[3][4], mFlippedA[3], mManifold[3][6];
    std::int64_t mTets = 0, mAmbiguous = 0;
};

} // namespace vdbtet
