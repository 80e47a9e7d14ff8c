/// @file TileTets.cc
/// The tets of slice S for all spines of an axis at a time.
#include "tets/TileTets.h"

namespace vdbtet {

void LocalFlips::clear() {
    for (int lattice = 0; lattice < 2; ++lattice) {
        for (int axis = 0; axis < 3; ++axis) mFlipped[lattice][axis] = mToB[lattice][axis] = PaddedMask();
    }
}

void LocalFlips::load(const Flips& flips, const Neighbours& neighbours) {
    clear();
    for (int slot = 0; slot < 27; ++slot) {
        if (neighbours[slot] < 0) continue;
        const TileMask& border = borderOf(slot);
        const int shift = PaddedMask::step(8 * (slot / 9 - 1), 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1));
        flips.forEach(neighbours[slot], [&](const Flip& flip) {
            if (!border.test(flip.vertex)) return;
            const int n = PaddedMask::bit(flip.vertex) + shift;
            mFlipped[flip.lattice][flip.axis].set(n);
            if (flip.slice == bcc::SliceB) mToB[flip.lattice][flip.axis].set(n);
        });
    }
}

void TileTets::load(TileRef tile, const LocalStates& states) {
    mTile = tile;
    mStates = &states;
    mChanges = nullptr;
    mTets = mAmbiguous = 0;
    if (tile == kInside) {
        mLocalFlips.clear();
    } else {
        mLocalFlips.load(mFlips, mVertices.layout.neighbours[tile]);
    }
    const auto count = [&](const LocalTet&) { ++mTets; };
    for (int axis = 0; axis < 3; ++axis) {
        mFlippedA[axis] = mLocalFlips.mask(bcc::A, axis).core();
        findLatticeTets(axis);
        mFlippedA[axis].forEach([&](int n) {
            const bcc::Slice slice = mLocalFlips.slice(axis, localIndex(bcc::A, n));
            mAmbiguous += visitFlipped(bcc::A, axis, slice, n, count);
        });
    }
    forEachFlipOfB([&](const Flip& flip) {
        mAmbiguous += visitFlipped(bcc::B, flip.axis, flip.slice, flip.vertex, count);
    });
}

void TileTets::change(const TileChanges* changes) {
    mChanges = changes;
    if (!changes) return;
    for (const TetCode code : changes->tets) {
        const LocalTet tet = tetOf(code);
        bool filled = true;
        for (int i = 0; i < 4; ++i) filled = filled && mStates->manifold(tet.vertex(i));
        mTets += filled ? 1 : -1;
        mAmbiguous -= filled;
        if (tet.slice != bcc::S) continue; // visitFlipped() looks for itself
        TileMask& tets = mLattice[tetAxis(code)][tet.number];
        filled ? tets.set(tetBit(code)) : tets.reset(tetBit(code));
    }
}

LocalTet TileTets::tetOf(TetCode code) const {
    const auto lattice = bcc::Lattice(tetLattice(code));
    const int lower = localIndex(lattice, tetBit(code));
    return {localOctahedron(lattice, tetAxis(code), lower), lattice, mLocalFlips.slice(tetAxis(code), lower),
            tetNumber(code)};
}

void TileTets::findLatticeTets(int axis) {
    TileMask present[6];
    auto& manifold = mManifold[axis];
    for (int v = 0; v < 6; ++v) {
        const bcc::Vertex& at = bcc::kOctahedra[bcc::A][axis][v];
        manifold[v] = mStates->manifoldMask(at.lattice).shifted(at.x, at.y, at.z);
        present[v] = mStates->interiorMask(at.lattice).shifted(at.x, at.y, at.z) | manifold[v];
    }
    for (int number = 0; number < 4; ++number) {
        const auto& tet = bcc::kSliceTets[bcc::S][number];
        const bcc::RingEdge& edge = bcc::kRingEdges[number];
        const bcc::Vertex& lower = bcc::kOctahedra[bcc::A][axis][edge.lower];
        const TileMask gone =
            mFlippedA[axis] |
            mLocalFlips.mask(bcc::B, (axis + edge.axisOffset) % 3).shifted(lower.x, lower.y, lower.z);
        const TileMask all = present[tet[0]] & present[tet[1]] & present[tet[2]] & present[tet[3]] & ~gone;
        TileMask& ambiguous = mAmbiguousOf[axis][number];
        ambiguous = all & manifold[tet[0]] & manifold[tet[1]] & manifold[tet[2]] & manifold[tet[3]];
        mLattice[axis][number] = all & ~ambiguous;
        mTets += mLattice[axis][number].count();
        mAmbiguous += ambiguous.count();
    }
}

} // namespace vdbtet
