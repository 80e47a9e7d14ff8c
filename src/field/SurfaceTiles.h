/// @file SurfaceTiles.h
/// From the blocks of voxels whose values change sign to the lattice tiles near them.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "field/SurfaceBlocks.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

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
        for (auto it = box.begin(); it; ++it) add(*it);
    }
    void add(const openvdb::Coord& tile) {
        mTiles.push_back(tile);
        if (mTiles.size() > mCompactAt) compact();
    }

    const Coords& tiles() const { return mTiles; }

private:
    void compact() {
        std::sort(mTiles.begin(), mTiles.end());
        mTiles.erase(std::unique(mTiles.begin(), mTiles.end()), mTiles.end());
        if (std::int64_t(mTiles.size()) > mLimit) throwTooManyTiles(mLimit);
        mCompactAt = 2 * mTiles.size() + kRoom;
    }

    static constexpr size_t kRoom = 1 << 16;

    std::int64_t mLimit;
    Coords mTiles;
    size_t mCompactAt = kRoom;
};

/// Collects the lattice tiles that matter to the mixed cubes of blocks; see Field::surfaceTiles(). One for
/// each thread.
class NearTiles {
public:
    /// @param margin  0 or 1, cells
    NearTiles(const Frame& frame, std::int64_t limit, int margin)
        : mFrame(frame), mOnVoxels(frame.toIndex == openvdb::Mat3d::identity()), mMargin(margin),
          mTiles(limit) {}

    void operator()(const openvdb::Coord& block, const TileMask& mixed) {
        mOnVoxels ? addOnVoxels(block, mixed) : addAnywhere(block, mixed);
    }

    /// Those found, some more than once.
    const Coords& tiles() const { return mTiles.tiles(); }

private:
    /// The block is a tile, and a cut edge has both its ends in the box of a mixed cube. So a cube matters to
    /// the neighbours whose border its box touches: octahedra reach half a cell below the tile's vertices and
    /// one above, and the margin comes on top.
    void addOnVoxels(const openvdb::Coord& block, const TileMask& mixed) {
        // By the step to the neighbour.
        std::uint64_t slabs[3] = {mixed.words[0], 0, mixed.words[7]};
        if (mMargin > 0) slabs[0] |= mixed.words[1], slabs[2] |= mixed.words[6];
        for (std::uint64_t word : mixed.words) slabs[1] |= word;
        constexpr std::uint64_t kAll = ~std::uint64_t(0);
        constexpr std::uint64_t kAllRows[2][3] = {{0xff, kAll, std::uint64_t(0xff) << 56},
                                                  {0xffff, kAll, std::uint64_t(0xffff) << 48}};
        constexpr std::uint64_t kAllBits[2][3] = {{0x0101010101010101, kAll, 0x8080808080808080},
                                                  {0x0303030303030303, kAll, 0xc0c0c0c0c0c0c0c0}};
        const auto &kRows = kAllRows[mMargin], &kBits = kAllBits[mMargin];
        for (int slot = 0; slot < 27; ++slot) {
            const int x = slot / 9, y = slot / 3 % 3, z = slot % 3;
            if (slabs[x] & kRows[y] & kBits[z]) mTiles.add(block.offsetBy(x - 1, y - 1, z - 1));
        }
    }

    /// A cut edge may touch the box with its ends half a cell away from it.
    void addAnywhere(const openvdb::Coord& block, const TileMask& mixed) {
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
                if (box != last) mTiles.add(box);
                last = box;
            }
        }
    }

    /// @return the tiles near a box of index space.
    openvdb::CoordBBox tilesNear(const openvdb::Vec3d& low, const openvdb::Vec3d& size) const {
        const openvdb::Vec3d centre = mFrame.fromIndex * (low + 0.5 * size);
        const double reach = kReach + mMargin;
        openvdb::Coord min, max;
        for (int axis = 0; axis < 3; ++axis) {
            double half = 0.0;
            for (int j = 0; j < 3; ++j) half += 0.5 * size[j] * std::abs(mFrame.fromIndex(axis, j));
            // The vertices of tile t reach from 8t to 8t + 7.5.
            const double first = std::ceil((centre[axis] - half - reach - 7.5) / 8.0);
            const double last = std::floor((centre[axis] + half + reach) / 8.0);
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

    static constexpr double kReach = 1.5 + 1e-3; ///< lattice units: half a cell, and an octahedron's

    Frame mFrame;
    bool mOnVoxels;
    int mMargin;
    TileSet mTiles;
};

/// Field::surfaceTiles() of a VDB tree.
template <typename TreeT>
Coords tilesNearSurface(const TreeT& tree, const Frame& frame, const Level& level, std::int64_t maxTiles,
                        int margin, Interrupt& interrupt) {
    tbb::enumerable_thread_specific<NearTiles> parts(frame, maxTiles, margin);
    forEachSurfaceBlock(tree, level, maxTiles, interrupt, parts,
                        [](const openvdb::CoordBBox&) { return true; });
    Coords tiles;
    for (const NearTiles& part : parts) tiles.insert(tiles.end(), part.tiles().begin(), part.tiles().end());
    tbb::parallel_sort(tiles.begin(), tiles.end());
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    if (std::int64_t(tiles.size()) > maxTiles) throwTooManyTiles(maxTiles);
    return tiles;
}

} // namespace vdbtet
