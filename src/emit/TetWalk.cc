#include "emit/TetWalk.h"

namespace vdbtet {

void TetWalk::load(TileRef tile) {
    mTile = tile;
    mNeighbours = &mVertices.layout.neighbours[tile];
    mLocal.load(mVertices, tile);
    mAnyFlipsB = false;
    for (TileRef neighbour : *mNeighbours) {
        if (neighbour < 0) continue;
        for (const auto& slices : mFlips.tiles[neighbour][bcc::B]) {
            mAnyFlipsB = mAnyFlipsB || slices[0].any() || slices[1].any();
        }
    }
}

TileMask TetWalk::relevantSpines(int axis, TileMask& plain) const {
    TileMask any;
    plain = TileMask::filled(true);
    for (const bcc::Vertex& v : bcc::kOctahedra[bcc::A][axis]) {
        const TileMask interior = mLocal.interior(v.lattice).shifted(v.x, v.y, v.z);
        any |= interior;
        plain &= interior;
    }
    const PaddedMask& manifold = mLocal.manifoldMask(bcc::A);
    return any | (manifold.shifted(0, 0, 0) & manifold.shifted(axis == 0, axis == 1, axis == 2));
}

bool TetWalk::ringEdgeFlipped(int axis, int base, int number) const {
    const bcc::RingEdge& edge = bcc::kRingEdges[number];
    const bcc::Vertex& lower = bcc::kOctahedra[bcc::A][axis][edge.lower];
    const int x = base / 100 - 1, y = base / 10 % 10 - 1, z = base % 10 - 1;
    return slice(bcc::B, (axis + edge.axisOffset) % 3, x + lower.x, y + lower.y, z + lower.z) != bcc::S;
}

bcc::Slice TetWalk::slice(int lattice, int axis, int x, int y, int z) const {
    const TileRef tile = (*mNeighbours)[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    if (tile < 0) return bcc::S;
    const auto& slices = mFlips.tiles[tile][lattice][axis];
    const int n = TileMask::bit(x & 7, y & 7, z & 7);
    return slices[0].test(n) ? bcc::SliceA : slices[1].test(n) ? bcc::SliceB : bcc::S;
}

State TetWalk::stateAt(int lattice, int x, int y, int z) const {
    const TileRef tile = (*mNeighbours)[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    if (tile < 0) return tile == kInside ? State::Inside : State::Outside;
    const int n = TileMask::bit(x & 7, y & 7, z & 7);
    if (mVertices.labels.manifold[tile][lattice].test(n)) return State::Manifold;
    return mVertices.signs[tile][lattice].test(n) ? State::Inside : State::Outside;
}

} // namespace vdbtet
