/// @file SurfaceTiles.h
/// From the blocks of voxels whose values change sign to the lattice tiles near them.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "field/SurfaceBlocks.h"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>

namespace vdbtet {

/// A set of tiles that many boxes of tiles overlap in; it never holds more than a few times its limit.
class TileSet {
public:
    /// @param limit  adding throws TooLarge once there are more tiles than this
    explicit TileSet(std::int64_t limit) : mLimit(limit) {}

    void add(const openvdb::CoordBBox& box) {
        const openvdb::Vec3d size(double(box.max().x()) - box.min().x() + 1.0,
                                  double(box.max().y()) - box.min().y() + 1.0,
                                  double(box.max().z()) - box.min().z() + 1.0);
        if (size.x() * size.y() * size.z() > double(mLimit)) throwTooManyTiles(mLimit);
        for (auto it = box.begin(); it; ++it) mTiles.push_back(*it);
        if (mTiles.size() > mCompactAt) compact();
    }

    /// @return the tiles in ascending order.
    const Coords& compact() {
        std::sort(mTiles.begin(), mTiles.end());
        mTiles.erase(std::unique(mTiles.begin(), mTiles.end()), mTiles.end());
        if (std::int64_t(mTiles.size()) > mLimit) throwTooManyTiles(mLimit);
        mCompactAt = 2 * mTiles.size() + 4096;
        return mTiles;
    }

private:
    std::int64_t mLimit;
    Coords mTiles;
    size_t mCompactAt = 4096;
};

/// Finds the lattice tiles that come within some clearance of the mixed cubes of a block.
class NearTiles {
public:
    NearTiles(const Frame& frame, double clearance) : mFrame(frame), mReach(clearance + 1e-3) {}

    void append(const openvdb::Coord& block, const TileMask& mixed, TileSet& tiles) {
        openvdb::CoordBBox last;
        for (int x = 0; x < 8; ++x) {
            for (int y = 0; y < 8; ++y) {
                const unsigned row = unsigned(mixed.words[x] >> (8 * y) & 0xff);
                if (row == 0) continue;
                // One box for the row, from its first mixed cube to its last. Most rows of a block mark the
                // same tiles.
                const int begin = lowestBit(row), end = 32 - __builtin_clz(row);
                const openvdb::Vec3d low(8.0 * block.x() + x, 8.0 * block.y() + y, 8.0 * block.z() + begin);
                const openvdb::CoordBBox box = tilesNear(low, openvdb::Vec3d(1.0, 1.0, end - begin));
                if (box != last) tiles.add(box);
                last = box;
            }
        }
    }

private:
    /// @return the tiles near a box of index space.
    openvdb::CoordBBox tilesNear(const openvdb::Vec3d& low, const openvdb::Vec3d& size) const {
        const openvdb::Vec3d centre = mFrame.fromIndex * (low + 0.5 * size);
        openvdb::Coord min, max;
        for (int axis = 0; axis < 3; ++axis) {
            double half = 0.0;
            for (int j = 0; j < 3; ++j) half += 0.5 * size[j] * std::abs(mFrame.fromIndex(axis, j));
            // The vertices of tile t reach from 8t to 8t + 7.5.
            const double first = std::ceil((centre[axis] - half - mReach - 7.5) / 8.0);
            const double last = std::floor((centre[axis] + half + mReach) / 8.0);
            // Local coordinates and neighbours of tiles must stay within 32 bits.
            constexpr double kFarthest = 2.0e9;
            if (!(first > -kFarthest && last < kFarthest)) {
                throw TooLarge("the spacing is so small that the lattice's coordinates leave 32 bits; use a "
                               "coarser one");
            }
            min[axis] = int(first);
            max[axis] = int(last);
        }
        return openvdb::CoordBBox(min, max);
    }

    Frame mFrame;
    double mReach;
};

/// Field::surfaceTiles() of a VDB tree.
template <typename TreeT>
Coords tilesNearSurface(const TreeT& tree, const Frame& frame, const Level& level, double clearance,
                        std::int64_t maxTiles, Interrupt& interrupt) {
    const Coords blocks = surfaceBlocks(tree, level, maxTiles);
    tbb::enumerable_thread_specific<TileSet> parts(maxTiles);
    parallelRanges(std::int64_t(blocks.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        BlockSigns<TreeT> signs(tree, level);
        NearTiles nearTiles(frame, clearance);
        TileSet& tiles = parts.local();
        for (std::int64_t b = begin; b < end; ++b) {
            const TileMask mixed = signs.mixedCubes(blocks[b]);
            if (mixed.any()) nearTiles.append(blocks[b], mixed, tiles);
        }
    });
    Coords tiles;
    for (TileSet& part : parts) {
        const Coords& more = part.compact();
        tiles.insert(tiles.end(), more.begin(), more.end());
    }
    sortUnique(tiles);
    if (std::int64_t(tiles.size()) > maxTiles) throwTooManyTiles(maxTiles);
    return tiles;
}

} // namespace vdbtet
