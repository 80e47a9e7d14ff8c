/// @file SurfaceBlocks.h
/// Finds the surface in a VDB tree: the blocks of 8^3 voxels whose values change sign.
///
/// The sign of the values decides, never the active mask. A trilinear field changes sign only in cubes whose
/// corners do, and such a cube has a corner inside. That corner lies in a leaf or, the background being
/// outside, in one of finitely many constant tiles.
#pragma once

#include "bits/PaddedMask.h"
#include "field/Level.h"

#include <vdbtet/Errors.h>

#include <openvdb/Types.h>
#include <openvdb/tree/ValueAccessor.h>

#include <tbb/parallel_sort.h>

#include <algorithm>
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
        const PaddedMask padded(around);
        TileMask any = TileMask::filled(false), all = TileMask::filled(true);
        for (int corner = 0; corner < 8; ++corner) {
            const TileMask shifted = padded.shifted(corner >> 2, corner >> 1 & 1, corner & 1);
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

} // namespace vdbtet
