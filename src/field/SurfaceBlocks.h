/// @file SurfaceBlocks.h
/// Finds the surface in a VDB tree: first the 8^3-voxel blocks whose values change sign, then the lattice
/// tiles near them.
///
/// The sign of the values decides, never the active mask. A trilinear field changes sign only in cubes whose
/// corners do, and such a cube has a corner inside. That corner lies in a leaf or, the background being
/// outside, in one of finitely many constant tiles.
#pragma once

#include "bcc/Frame.h"
#include "bits/TileMask.h"
#include "field/Level.h"

#include <vdbtet/Errors.h>

#include <openvdb/Types.h>
#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace vdbtet {

using Coords = std::vector<openvdb::Coord>;

inline void sortUnique(Coords& coords) {
    tbb::parallel_sort(coords.begin(), coords.end());
    coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
}

[[noreturn]] inline void throwTooManyTiles(std::int64_t maxTiles) {
    throw TooLarge("the surface crosses more than " + std::to_string(maxTiles) +
                   " lattice tiles of 8 x 8 x 8 cells; use a coarser spacing, or raise the limit");
}

/// @throw BadValue where a leaf, a tile or the background holds NaN or an infinity
template <typename GridT>
void requireFinite(const GridT& grid) {
    struct Found {
        std::int64_t count = 0;
        openvdb::Coord first = openvdb::Coord::max();

        void add(const openvdb::Coord& at) {
            ++count;
            first = std::min(first, at);
        }
    };
    using TreeT = typename GridT::TreeType;
    const openvdb::tree::LeafManager<const TreeT> leaves(grid.tree());
    Found found = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, leaves.leafCount(), 64), Found(),
        [&](const tbb::blocked_range<size_t>& range, Found part) {
            for (size_t l = range.begin(); l != range.end(); ++l) {
                const auto* data = leaves.leaf(l).buffer().data();
                for (int n = 0; n < TileMask::kSize; ++n) {
                    if (!std::isfinite(data[n])) part.add(leaves.leaf(l).offsetToGlobalCoord(n));
                }
            }
            return part;
        },
        [](Found a, const Found& b) {
            a.count += b.count;
            a.first = std::min(a.first, b.first);
            return a;
        });
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(tile.getLeafDepth() - 1);
    for (; tile; ++tile) {
        if (!std::isfinite(tile.getValue())) found.add(tile.getCoord());
    }
    if (!std::isfinite(grid.background())) throw BadValue("the background value is not a finite number");
    if (found.count != 0) {
        std::ostringstream message;
        message << found.count << " voxels or tiles hold NaN or infinite values, the first at " << found.first
                << "; such values have no sign, replace them first";
        throw BadValue(message.str());
    }
}

/// The voxel blocks of a tree by sign.
template <typename TreeT>
class BlockSigns {
public:
    using LeafT = typename TreeT::LeafNodeType;
    static_assert(LeafT::DIM == 8, "tiles are made for leaves of 8^3 voxels");

    BlockSigns(const TreeT& tree, const Level& level) : mAccessor(tree), mLevel(level) {}

    bool isLeaf(const openvdb::Coord& block) { return mAccessor.probeConstLeaf(origin(block)) != nullptr; }

    TileMask inside(const openvdb::Coord& block) {
        const auto* leaf = mAccessor.probeConstLeaf(origin(block));
        if (!leaf) return TileMask::filled(mLevel.phi(mAccessor.getValue(origin(block))) >= 0.0);
        TileMask mask;
        const auto* data = leaf->buffer().data();
        for (int w = 0; w < 8; ++w) {
            for (int n = 0; n < 64; ++n) {
                mask.words[w] |= std::uint64_t(mLevel.phi(data[w << 6 | n]) >= 0.0) << n;
            }
        }
        return mask;
    }

    /// @return the cubes, by their lower corner in @a block, whose corners differ in sign.
    TileMask mixedCubes(const openvdb::Coord& block) {
        std::array<TileMask, 27> masks;
        MasksAround around;
        around.masks.fill(&masks[neighbourSlot(0, 0, 0)]);
        for (int corner = 0; corner < 8; ++corner) {
            const int dx = corner >> 2, dy = corner >> 1 & 1, dz = corner & 1;
            const int slot = neighbourSlot(dx, dy, dz);
            masks[slot] = inside(block.offsetBy(dx, dy, dz));
            around.masks[slot] = &masks[slot];
        }
        TileMask any = TileMask::filled(false), all = TileMask::filled(true);
        for (int corner = 0; corner < 8; ++corner) {
            const TileMask shifted = around.shifted(corner >> 2, corner >> 1 & 1, corner & 1);
            any |= shifted;
            all &= shifted;
        }
        return any & ~all;
    }

private:
    static openvdb::Coord origin(const openvdb::Coord& block) {
        return openvdb::Coord(8 * block.x(), 8 * block.y(), 8 * block.z());
    }

    openvdb::tree::ValueAccessor<const TreeT> mAccessor;
    Level mLevel;
};

/// Collects the blocks on both sides of every face between a constant tile inside and a constant region
/// outside.
template <typename TreeT>
class ConstantFaces {
public:
    /// @throw TooLarge once there are more than kBlocksPerTile for each of @a maxTiles
    ConstantFaces(const TreeT& tree, const Level& level, Coords& blocks, std::int64_t maxTiles)
        : mAccessor(tree), mLevel(level), mBlocks(blocks), mMaxTiles(maxTiles),
          mMaxBlocks(std::int64_t(blocks.size()) + kBlocksPerTile * maxTiles) {}

    /// @param tile  the voxels of a constant tile that is inside
    void visit(const openvdb::CoordBBox& tile) {
        const int size = tile.dim().x();
        for (int slot = 0; slot < 27; ++slot) {
            if (slot == neighbourSlot(0, 0, 0)) continue;
            const openvdb::Coord step(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
            visitNeighbour(
                tile, tile.min() + openvdb::Coord(size * step.x(), size * step.y(), size * step.z()), size);
        }
    }

private:
    // Blocks are cheap next to tiles, and a spacing coarser than the voxel merges many of them into a tile.
    static constexpr std::int64_t kBlocksPerTile = 8;

    static openvdb::CoordBBox cube(const openvdb::Coord& min, int size) {
        return openvdb::CoordBBox::createCube(min, size);
    }
    static openvdb::CoordBBox grown(openvdb::CoordBBox box) {
        box.expand(8);
        return box;
    }

    /// The edge length of the region of one value, or of the leaf, that holds voxel @a at.
    int regionSize(const openvdb::Coord& at) {
        using RootT = typename TreeT::RootNodeType;
        using UpperT = typename RootT::ChildNodeType;
        switch (mAccessor.getValueDepth(at)) {
        case 3:
            return 0; // a leaf
        case 2:
            return TreeT::LeafNodeType::DIM;
        case 1:
            return UpperT::ChildNodeType::DIM;
        default:
            return UpperT::DIM; // a tile of the root, or the background
        }
    }

    /// Follow the tile's border into the region of @a size at @a min, down to regions of one value.
    void visitNeighbour(const openvdb::CoordBBox& tile, const openvdb::Coord& min, int size) {
        openvdb::CoordBBox shell = grown(tile);
        const openvdb::CoordBBox region = cube(min, size);
        shell.intersect(region);
        if (shell.empty()) return;
        const int constant = regionSize(min);
        if (constant >= size) {
            if (mLevel.phi(mAccessor.getValue(min)) >= 0.0) return;
            addBlocks(shell);
            openvdb::CoordBBox inner = grown(region);
            inner.intersect(tile);
            addBlocks(inner);
        } else if (constant != 0) {
            subdivide(tile, min, size);
        } else if (size > 8) {
            subdivide(tile, min, size);
        }
        // Else it is a leaf, which looks after its own borders.
    }

    void subdivide(const openvdb::CoordBBox& tile, const openvdb::Coord& min, int size) {
        const int part = size > 128 ? 128 : 8;
        openvdb::CoordBBox shell = grown(tile);
        shell.intersect(cube(min, size));
        auto aligned = [part](int x) { return x & ~(part - 1); };
        for (int x = aligned(shell.min().x()); x <= shell.max().x(); x += part) {
            for (int y = aligned(shell.min().y()); y <= shell.max().y(); y += part) {
                for (int z = aligned(shell.min().z()); z <= shell.max().z(); z += part) {
                    visitNeighbour(tile, openvdb::Coord(x, y, z), part);
                }
            }
        }
    }

    void addBlocks(const openvdb::CoordBBox& voxels) {
        if (voxels.empty()) return;
        const openvdb::CoordBBox box(voxels.min() >> 3, voxels.max() >> 3);
        if (std::int64_t(mBlocks.size()) + std::int64_t(box.volume()) > mMaxBlocks)
            throwTooManyTiles(mMaxTiles);
        for (auto it = box.begin(); it; ++it) mBlocks.push_back(*it);
    }

    openvdb::tree::ValueAccessor<const TreeT> mAccessor;
    Level mLevel;
    Coords& mBlocks;
    std::int64_t mMaxTiles, mMaxBlocks;
};

/// @return the blocks, in ascending order, that may own a cube of mixed signs.
template <typename TreeT>
Coords surfaceBlocks(const TreeT& tree, const Level& level, std::int64_t maxTiles) {
    Coords blocks;
    BlockSigns<TreeT> signs(tree, level);
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord block = leaf->origin() >> 3;
        blocks.push_back(block);
        // A cube belongs to the block of its lower corner: those that reach into the leaf from constant
        // regions below it count too.
        for (int corner = 1; corner < 8; ++corner) {
            const openvdb::Coord lower = block.offsetBy(-(corner >> 2), -(corner >> 1 & 1), -(corner & 1));
            if (!signs.isLeaf(lower)) blocks.push_back(lower);
        }
    }
    ConstantFaces<TreeT> faces(tree, level, blocks, maxTiles);
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(tile.getLeafDepth() - 1);
    for (; tile; ++tile) {
        if (level.phi(*tile) >= 0.0) faces.visit(tile.getBoundingBox());
    }
    sortUnique(blocks);
    return blocks;
}

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
                        std::int64_t maxTiles) {
    const Coords blocks = surfaceBlocks(tree, level, maxTiles);
    struct Part {
        Coords tiles;
        size_t compactAt = 4096;
    };
    tbb::enumerable_thread_specific<Part> parts;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, blocks.size(), 64), [&](const tbb::blocked_range<size_t>& range) {
            BlockSigns<TreeT> signs(tree, level);
            NearTiles nearTiles(frame, clearance);
            Part& part = parts.local();
            for (size_t b = range.begin(); b != range.end(); ++b) {
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
