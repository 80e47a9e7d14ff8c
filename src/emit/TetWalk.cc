/// @file TetWalk.cc
/// What a tile's tets look like to their neighbours.
#include "emit/TetWalk.h"

namespace vdbtet {

void TetWalk::load(TileRef tile) {
    mTile = tile;
    mLocal.load(mVertices, tile);
    for (bcc::Slice* slice : mFlipped) *slice = bcc::S;
    mFlipped.clear();
    for (int slot = 0; slot < 27; ++slot) {
        const TileRef from = mLocal.neighbours()[slot];
        if (from < 0) continue;
        mFlips.forEach(from, [&](const Flip& flip) {
            const int x = (flip.vertex >> 6) + 8 * (slot / 9 - 1),
                      y = (flip.vertex >> 3 & 7) + 8 * (slot / 3 % 3 - 1),
                      z = (flip.vertex & 7) + 8 * (slot % 3 - 1);
            if (x < -1 || x > 8 || y < -1 || y > 8 || z < -1 || z > 8) return;
            mFlipped.push_back(&mSlices[flip.axis][localIndex(flip.lattice, x, y, z)]);
            *mFlipped.back() = flip.slice;
        });
    }
}

TileMask TetWalk::relevantSpines(int axis, TileMask& plain) const {
    TileMask any;
    plain = TileMask::filled(true);
    const MasksAround interior[2] = {mLocal.interior().masks(bcc::A), mLocal.interior().masks(bcc::B)};
    for (const bcc::Vertex& v : bcc::kOctahedra[bcc::A][axis]) {
        const TileMask shifted = interior[v.lattice].shifted(v.x, v.y, v.z);
        any |= shifted;
        plain &= shifted;
    }
    const MasksAround manifold = Surroundings(mLocal.neighbours()).masks(mVertices.labels.manifold, bcc::A);
    return any | (manifold.shifted(0, 0, 0) & manifold.shifted(axis == 0, axis == 1, axis == 2));
}

State TetWalk::stateAt(int lattice, int x, int y, int z) const {
    const TileRef tile = mLocal.neighbours()[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    if (tile < 0) return tile == kInside ? State::Inside : State::Outside;
    const int n = TileMask::bit(x & 7, y & 7, z & 7);
    if (mVertices.labels.manifold[tile][lattice].test(n)) return State::Manifold;
    return mVertices.signs[tile][lattice].test(n) ? State::Inside : State::Outside;
}

} // namespace vdbtet
