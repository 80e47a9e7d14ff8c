/// @file LocalOctants.cc
/// Gathers levels from 27 tiles.
#include "grading/LocalOctants.h"

namespace vdbtet {

namespace {

const TileMask kNone = TileMask::filled(false);

/// @return the bits along z of the octants of @a level in a tile, at (x,y) in units of their edge.
unsigned rowOf(const OctantPart& part, int level, int x, int y) {
    switch (level) {
    case 1:
        return unsigned(part.set.level1 >> (x << 4 | y << 2) & 0xf);
    case 2:
        return unsigned(part.set.level2 >> (x << 2 | y << 1) & 0x3);
    default:
        return part.set.level3;
    }
}

PaddedMask levelOf(const std::array<OctantPart, 27>& parts, int level) {
    const int dim = TileMask::kDim >> level;
    const auto step = [dim](int at) { return at < 0 ? -1 : at >= dim ? 1 : 0; };
    PaddedMask mask;
    for (int x = -1; x <= dim; ++x) {
        for (int y = -1; y <= dim; ++y) {
            const OctantPart* column = &parts[neighbourSlot(step(x), step(y), -1)];
            const int ownX = x & (dim - 1), ownY = y & (dim - 1);
            const unsigned below = rowOf(column[0], level, ownX, ownY) >> (dim - 1),
                           own = rowOf(column[1], level, ownX, ownY),
                           above = rowOf(column[2], level, ownX, ownY) & 1;
            mask.rows[PaddedMask::bit(x, y, -1) >> 4] = std::uint16_t(below | own << 1 | above << (dim + 1));
        }
    }
    return mask;
}

/// @return the corners from 0 to @a dim of octants from -1 to @a dim.
PaddedMask cornersOf(const PaddedMask& octants, int dim) {
    PaddedMask corners;
    for (int x = 0; x <= dim; ++x) {
        for (int y = 0; y <= dim; ++y) {
            const std::uint16_t* row = octants.rows + (PaddedMask::bit(x, y, -1) >> 4);
            const unsigned near = row[0] | row[-1] | row[-PaddedMask::kDim] | row[-PaddedMask::kDim - 1];
            corners.rows[PaddedMask::bit(x, y, -1) >> 4] = std::uint16_t(near | near << 1);
        }
    }
    return corners;
}

/// Set the vertices 2^level (x,y,z) + shift (1,1,1) for the bits from 0 of @a mask.
void spread(const PaddedMask& mask, int level, int shift, TileMask& vertices) {
    const int dim = TileMask::kDim >> level;
    for (int x = 0; x < dim; ++x) {
        for (int y = 0; y < dim; ++y) {
            const unsigned row = mask.rows[PaddedMask::bit(x, y, -1) >> 4] >> 1;
            unsigned bits = 0;
            for (int z = 0; z < dim; ++z) bits |= (row >> z & 1) << ((z << level) + shift);
            vertices.words[(x << level) + shift] |= std::uint64_t(bits) << (8 * ((y << level) + shift));
        }
    }
}

} // namespace

void LocalOctants::load(const std::array<OctantPart, 27>& parts, const openvdb::Coord& tile, int coarsest) {
    mTile = tile;
    mCoarsest = coarsest;
    MasksAround units;
    for (int slot = 0; slot < 27; ++slot) units.masks[slot] = parts[slot].units ? parts[slot].units : &kNone;
    mExists[0] = PaddedMask(units);
    for (int level = 1; level <= coarsest; ++level) mExists[level] = levelOf(parts, level);
    for (int level = 0; level <= coarsest && level < kLevels - 1; ++level)
        mCorners[level] = cornersOf(mExists[level], TileMask::kDim >> level);
    for (int slot = 0; slot < 8; ++slot)
        mInside[slot] = parts[neighbourSlot(slot >> 2, slot >> 1 & 1, slot & 1)].inside;
}

TileMask LocalOctants::vertices() const {
    TileMask vertices = mCorners[0].core();
    for (int level = 1; level <= mCoarsest; ++level) {
        // Of the tile's own corners only the lowest is in it.
        spread(level < kLevels - 1 ? mCorners[level] : mExists[level], level, 0, vertices);
        spread(mExists[level], level, 1 << (level - 1), vertices);
    }
    return vertices;
}

} // namespace vdbtet
