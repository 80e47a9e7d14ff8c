/// @file SurfaceBlocks.h
/// Finds the surface in a VDB tree: the blocks of 8^3 voxels whose values change sign.
///
/// The sign of the values decides, never the active mask. A trilinear field changes sign only in cubes whose
/// corners do, and such a cube has a corner inside. That corner lies in a leaf or, the background being
/// outside, in one of finitely many constant tiles.
#pragma once

#include "Parallel.h"
#include "bits/PaddedMask.h"
#include "field/Level.h"
#include "field/TreeNodes.h"
#include "simd/Isa.h"

#include <vdbtet/Errors.h>

#include <openvdb/Types.h>
#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace vdbtet {

[[noreturn]] inline void throwTooManyTiles(std::int64_t maxTiles) {
    throw TooLarge("the surface crosses more than " + std::to_string(maxTiles) +
                   " lattice tiles of 8 x 8 x 8 cells; use a coarser spacing, or raise the limit");
}

/// Neighbours of what holds the surface must have coordinates, too.
inline void requireRoom(const openvdb::Coord& min, int size) {
    const std::int64_t room = std::max(size, 64);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::int64_t(min[axis]) - room < std::numeric_limits<openvdb::Int32>::min() ||
            std::int64_t(min[axis]) + size + room > std::numeric_limits<openvdb::Int32>::max()) {
            throw TooLarge("the shape reaches the ends of the grid's 32-bit coordinates; move it away from "
                           "them, and the transform back");
        }
    }
}

/// A box of voxels at a leaf's lower corner.
struct LeafPart {
    int x = 8, y = 8, z = 8; ///< its size: 8 or 1

    /// The part that neighbours the leaf in the direction of a negative step, for each step other than 0.
    static LeafPart facing(int dx, int dy, int dz) { return {dx ? 1 : 8, dy ? 1 : 8, dz ? 1 : 8}; }

    TileMask mask() const {
        TileMask mask;
        const std::uint64_t row = z == 8 ? 0xff : 1, slab = y == 8 ? row * 0x0101010101010101 : row;
        for (int i = 0; i < x; ++i) mask.words[i] = slab;
        return mask;
    }
};

/// @return those of a leaf's voxels in @a part that are inside.
template <typename T>
TileMask insideVoxels(const T* data, const Level& level, const LeafPart& part) {
    TileMask mask;
    const double isovalue = level.isovalue, sign = level.insideIsBelow ? -1.0 : 1.0;
    const auto inside = [&](double value)
                            VDBTET_KERNEL { return sign * (value - isovalue) >= 0.0 ? 1u : 0u; };
    if (part.z == 8) {
        runOn(bestIsa(), [&]() VDBTET_KERNEL {
            for (int x = 0; x < part.x; ++x) {
                for (int y = 0; y < part.y; ++y) {
                    std::uint32_t row = 0;
                    for (int z = 0; z < 8; ++z) row |= inside(double(data[x << 6 | y << 3 | z])) << z;
                    mask.words[x] |= std::uint64_t(row) << (8 * y);
                }
            }
        });
    } else {
        for (int x = 0; x < part.x; ++x) {
            for (int y = 0; y < part.y; ++y)
                mask.words[x] |= std::uint64_t(inside(double(data[x << 6 | y << 3]))) << (8 * y);
        }
    }
    return mask;
}

/// The voxel blocks of a tree by sign.
template <typename TreeT>
class BlockSigns {
public:
    using LeafT = typename TreeT::LeafNodeType;
    static_assert(LeafT::DIM == 8, "tiles are made for leaves of 8^3 voxels");

    BlockSigns(const TreeT& tree, const Level& level) : mAccessor(tree), mLevel(level) {}

    bool isLeaf(const openvdb::Coord& block) { return mAccessor.probeConstLeaf(origin(block)) != nullptr; }

    /// @return those voxels of a block in @a part that are inside.
    TileMask inside(const openvdb::Coord& block, const LeafPart& part) {
        if (const auto* leaf = mAccessor.probeConstLeaf(origin(block)))
            return insideVoxels(leaf->buffer().data(), mLevel, part);
        return constantInside(block) ? part.mask() : TileMask();
    }
    /// The same of a block without a leaf, whose voxels are all alike.
    bool constantInside(const openvdb::Coord& block) {
        return mLevel.phi(mAccessor.getValue(origin(block))) >= 0.0;
    }

    /// @return the cubes, by their lower corner in @a block, whose corners differ in sign.
    TileMask mixedCubes(const openvdb::Coord& block) {
        std::array<TileMask, 27> masks;
        MasksAround around;
        around.masks.fill(&masks[neighbourSlot(-1, -1, -1)]);
        for (int corner = 0; corner < 8; ++corner) {
            const int dx = corner >> 2, dy = corner >> 1 & 1, dz = corner & 1;
            const int slot = neighbourSlot(dx, dy, dz);
            masks[slot] = inside(block.offsetBy(dx, dy, dz), LeafPart::facing(dx, dy, dz));
            around.masks[slot] = &masks[slot];
        }
        // Neighbours along z, then y, then x.
        PaddedMask any(around), all = any;
        for (int step : {PaddedMask::step(0, 0, 1), PaddedMask::step(0, 1, 0), PaddedMask::step(1, 0, 0)}) {
            any.add(any.movedDown(step));
            all.intersect(all.movedDown(step));
        }
        any.remove(all);
        return any.core();
    }

private:
    static openvdb::Coord origin(const openvdb::Coord& block) {
        return openvdb::Coord(8 * block.x(), 8 * block.y(), 8 * block.z());
    }

    openvdb::tree::ValueAccessor<const TreeT> mAccessor;
    Level mLevel;
};

using Coords = std::vector<openvdb::Coord>;

/// Collects the blocks on both sides of every face between a constant tile inside and a constant region
/// outside.
template <typename TreeT>
class ConstantFaces {
public:
    ConstantFaces(const TreeT& tree, const Level& level, std::int64_t maxTiles)
        : mAccessor(tree), mLevel(level), mMaxTiles(maxTiles) {}

    /// @param tile  the voxels of a constant tile that is inside
    /// @throw TooLarge once there are more than kBlocksPerTile for each of maxTiles, and at the ends of
    /// coordinates
    void visit(const openvdb::CoordBBox& tile) {
        const int size = tile.max().x() - tile.min().x() + 1; // dim() would overflow at the end
        requireRoom(tile.min(), size);
        for (int slot = 0; slot < 27; ++slot) {
            if (slot == neighbourSlot(0, 0, 0)) continue;
            const openvdb::Coord step(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
            visitNeighbour(
                tile, tile.min() + openvdb::Coord(size * step.x(), size * step.y(), size * step.z()), size);
        }
    }

    /// @return the blocks collected, each once.
    const Coords& blocks() {
        std::sort(mBlocks.begin(), mBlocks.end());
        mBlocks.erase(std::unique(mBlocks.begin(), mBlocks.end()), mBlocks.end());
        return mBlocks;
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
        if (std::int64_t(mBlocks.size()) + std::int64_t(box.volume()) > kBlocksPerTile * mMaxTiles)
            throwTooManyTiles(mMaxTiles);
        for (auto it = box.begin(); it; ++it) mBlocks.push_back(*it);
    }

    openvdb::tree::ValueAccessor<const TreeT> mAccessor;
    Level mLevel;
    Coords mBlocks;
    std::int64_t mMaxTiles;
};

/// @brief Call @a visit(block, mixed) for each block with cubes of mixed signs, some more than once, in any
/// order.
/// @param visitors  gives each thread its own
/// @param takes     takes(blocks): whether to look at any block in a box
template <typename TreeT, typename Visitors, typename Takes>
void forEachSurfaceBlock(const TreeT& tree, const Level& level, std::int64_t maxTiles, Interrupt& interrupt,
                         Visitors& visitors, const Takes& takes) {
    const auto visit = [&](BlockSigns<TreeT>& signs, const openvdb::Coord& block) {
        if (!takes(openvdb::CoordBBox(block, block))) return;
        const TileMask mixed = signs.mixedCubes(block);
        if (mixed.any()) visitors.local()(block, mixed);
    };
    using LeafT = typename TreeT::LeafNodeType;
    const openvdb::tree::LeafManager<const TreeT> leaves(tree);
    interrupt.expectLoops(1); // what follows takes long only where the tree has few leaves
    parallelRanges(std::int64_t(leaves.leafCount()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        BlockSigns<TreeT> signs(tree, level);
        for (std::int64_t l = begin; l < end; ++l) {
            const auto& leaf = leaves.leaf(std::size_t(l));
            requireRoom(leaf.origin(), int(LeafT::DIM));
            const openvdb::Coord block = leaf.origin() >> 3;
            visit(signs, block);
            // A cube belongs to the block of its lower corner: those that reach into the leaf from constant
            // regions below it count too.
            for (int corner = 1; corner < 8; ++corner) {
                const int dx = corner >> 2, dy = corner >> 1 & 1, dz = corner & 1;
                const openvdb::Coord lower = block.offsetBy(-dx, -dy, -dz);
                if (signs.isLeaf(lower)) continue;
                const LeafPart part = LeafPart::facing(dx, dy, dz);
                const TileMask inside = insideVoxels(leaf.buffer().data(), level, part);
                if (inside != (signs.constantInside(lower) ? part.mask() : TileMask())) visit(signs, lower);
            }
        }
    });

    // The constant tiles, those of leaf size by their parent nodes: there may be as many as voxels inside /
    // 512.
    const TreeNodes<TreeT> nodes(tree);
    const auto takesAround = [&](const openvdb::Coord& origin, int size) {
        const openvdb::Coord low = origin >> 3;
        return takes(openvdb::CoordBBox(low.offsetBy(-1), low.offsetBy(size / 8)));
    };
    const auto addFaces = [&](ConstantFaces<TreeT>& faces, const auto& node, int size) {
        forEachTile(node, [&](double value, openvdb::Index slot) {
            if (!(level.phi(value) >= 0.0)) return;
            const openvdb::Coord origin = node.offsetToGlobalCoord(slot);
            if (takesAround(origin, size)) faces.visit(openvdb::CoordBBox::createCube(origin, size));
        });
    };
    const auto visitBlocks = [&](const Coords& blocks, std::int64_t begin, std::int64_t end) {
        BlockSigns<TreeT> signs(tree, level);
        for (std::int64_t b = begin; b < end; ++b) visit(signs, blocks[b]);
    };
    parallelEach(std::int64_t(nodes.lower.size()), interrupt, [&](std::int64_t n) {
        ConstantFaces<TreeT> faces(tree, level, maxTiles);
        addFaces(faces, *nodes.lower[n], int(TreeT::LeafNodeType::DIM));
        visitBlocks(faces.blocks(), 0, std::int64_t(faces.blocks().size()));
    });
    ConstantFaces<TreeT> faces(tree, level, maxTiles);
    for (const auto* node : nodes.upper) addFaces(faces, *node, int(TreeNodes<TreeT>::LowerT::DIM));
    for (auto tile = tree.root().cbeginValueAll(); tile; ++tile) {
        if (level.phi(*tile) >= 0.0)
            faces.visit(openvdb::CoordBBox::createCube(tile.getCoord(), int(TreeNodes<TreeT>::UpperT::DIM)));
    }
    const Coords& blocks = faces.blocks();
    parallelRanges(std::int64_t(blocks.size()), interrupt,
                   [&](std::int64_t begin, std::int64_t end) { visitBlocks(blocks, begin, end); });
}

} // namespace vdbtet
