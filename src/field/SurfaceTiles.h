/// @file SurfaceTiles.h
/// From the blocks of voxels whose values change sign to the lattice tiles near them.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "field/SurfaceBlocks.h"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>

namespace vdbtet {

/// @brief Mark the lattice tiles that come within @a clearance of the mixed cubes of a block.
class NearTiles {
public:
    NearTiles(const Frame& frame, double clearance) : mFrame(frame), mReach(clearance + 1e-3) {}

    void append(const openvdb::Coord& block, const TileMask& mixed, Coords& tiles) {
        mMarked.clear();
        for (int x = 0; x < 8; ++x) {
            for (int y = 0; y < 8; ++y) {
                const unsigned row = unsigned(mixed.words[x] >> (8 * y) & 0xff);
                if (row == 0) continue;
                // One box for the row, from its first mixed cube to its last.
                const int first = lowestBit(row), last = 31 - __builtin_clz(row);
                const openvdb::Vec3d low(8.0 * block.x() + x, 8.0 * block.y() + y, 8.0 * block.z() + first);
                mark(low, openvdb::Vec3d(1.0, 1.0, last - first + 1.0));
            }
        }
        std::sort(mMarked.begin(), mMarked.end());
        mMarked.erase(std::unique(mMarked.begin(), mMarked.end()), mMarked.end());
        for (const auto& box : mMarked) {
            for (auto it = box.box.begin(); it; ++it) tiles.push_back(*it);
        }
    }

private:
    struct TileBox {
        openvdb::CoordBBox box;
        bool operator<(const TileBox& o) const {
            return box.min() < o.box.min() || (box.min() == o.box.min() && box.max() < o.box.max());
        }
        bool operator==(const TileBox& o) const { return box == o.box; }
    };

    /// Mark the tiles near a box of index space.
    void mark(const openvdb::Vec3d& low, const openvdb::Vec3d& size) {
        const openvdb::Vec3d centre = mFrame.fromIndex * (low + 0.5 * size);
        openvdb::Coord min, max;
        for (int axis = 0; axis < 3; ++axis) {
            double half = 0.0;
            for (int j = 0; j < 3; ++j) half += 0.5 * size[j] * std::abs(mFrame.fromIndex(axis, j));
            // The vertices of tile t reach from 8t to 8t + 7.5.
            const double first = std::ceil((centre[axis] - half - mReach - 7.5) / 8.0);
            const double last = std::floor((centre[axis] + half + mReach) / 8.0);
            if (!(first > -2.0e9 && last < 2.0e9)) {
                throw TooLarge(
                    "the spacing is so small that lattice coordinates leave 32 bits; use a coarser one");
            }
            min[axis] = int(first);
            max[axis] = int(last);
        }
        const TileBox box{{min, max}};
        if (mMarked.empty() || !(mMarked.back() == box)) mMarked.push_back(box);
    }

    Frame mFrame;
    double mReach;
    std::vector<TileBox> mMarked;
};

/// Field::surfaceTiles() of a VDB tree.
template <typename TreeT>
Coords tilesNearSurface(const TreeT& tree, const Frame& frame, const Level& level, double clearance,
                        std::int64_t maxTiles, Interrupt& interrupt) {
    const Coords blocks = surfaceBlocks(tree, level, maxTiles);
    struct Part {
        Coords tiles;
        size_t compactAt = 4096;
    };
    tbb::enumerable_thread_specific<Part> parts;
    parallelRanges(std::int64_t(blocks.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        BlockSigns<TreeT> signs(tree, level);
        NearTiles nearTiles(frame, clearance);
        Part& part = parts.local();
        for (std::int64_t b = begin; b < end; ++b) {
            const TileMask mixed = signs.mixedCubes(blocks[b]);
            if (mixed.any()) nearTiles.append(blocks[b], mixed, part.tiles);
        }
        // Neighbouring blocks mark the same tiles again and again: keep the part small.
        if (part.tiles.size() > part.compactAt) {
            std::sort(part.tiles.begin(), part.tiles.end());
            part.tiles.erase(std::unique(part.tiles.begin(), part.tiles.end()), part.tiles.end());
            if (std::int64_t(part.tiles.size()) > maxTiles) throwTooManyTiles(maxTiles);
            part.compactAt = 2 * part.tiles.size() + 4096;
        }
    });
    Coords tiles;
    for (const Part& part : parts) tiles.insert(tiles.end(), part.tiles.begin(), part.tiles.end());
    sortUnique(tiles);
    if (std::int64_t(tiles.size()) > maxTiles) throwTooManyTiles(maxTiles);
    return tiles;
}

} // namespace vdbtet
