/// @file VoxelSampler.h
/// The field where the lattice's vertices are voxel centres and centres of their cubes.
#pragma once

#include "field/Field.h"
#include "field/GradientRoot.h"
#include "field/Level.h"
#include "field/VoxelBlock.h"

#include <openvdb/tree/ValueAccessor.h>

#include <array>
#include <vector>

namespace vdbtet {

/// Samples the grid where L_A is the voxel centres and tiles are leaves: no position is ever computed.
template <typename GridT>
class VoxelSampler final : public Field::Sampler {
public:
    VoxelSampler(const GridT& grid, const Level& level) : mAccessor(grid.tree()), mLevel(level) {}

    void signs(const openvdb::Coord& tile, PaddedMask& a, PaddedMask& b) override {
        load(tile);
        mBlock.signs(a, b);
    }

    void nearerToA(const openvdb::Coord& tile, const PaddedEdgeMasks& edges, double tau,
                   PaddedEdgeMasks& nearer) override {
        load(tile);
        mBlock.nearerToA(edges, tau, nearer);
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const std::vector<ShortEdge>& edges,
                   double tau, float* distance) override {
        load(tile);
        mBlock.cutPoints(lattice, edges, tau, distance);
    }

    void alongGradient(const openvdb::Coord& tile, bcc::Lattice lattice,
                       const std::vector<std::uint16_t>& vertices, const std::vector<double>& reach,
                       openvdb::Vec3d* offsets) override {
        load(tile);
        const openvdb::Coord origin(8 * tile.x(), 8 * tile.y(), 8 * tile.z());
        const auto beyond = [&](const openvdb::Coord& voxel) {
            return mLevel.phi(mAccessor.getValue(origin + voxel));
        };
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            double around[bcc::kDirections];
            mBlock.around(lattice, vertices[i], around);
            offsets[i] = rootAlongGradient(mBlock.at(lattice, vertices[i]), around, reach[i],
                                           [&](const openvdb::Vec3d& offset) {
                                               return mBlock.near(lattice, vertices[i], offset, beyond);
                                           });
        }
    }

private:
    using ValueT = typename GridT::ValueType;
    using ParentT = typename GridT::TreeType::RootNodeType::ChildNodeType::ChildNodeType; ///< of leaves

    /// Copy the tile's voxels and a border of one from the leaves.
    void load(const openvdb::Coord& tile) {
        if (mLoaded && tile == mTile) return;
        mLoaded = true;
        mTile = tile;
        std::array<const ValueT*, 27> leaves;
        const openvdb::Coord own(8 * tile.x(), 8 * tile.y(), 8 * tile.z());
        // Most leaves around are in the same node: it is asked once.
        const auto* node = mAccessor.template probeConstNode<ParentT>(own);
        constexpr int kLog2 = ParentT::LOG2DIM, kMost = (1 << kLog2) - 1;
        const openvdb::Coord place = tile & kMost;
        for (int slot = 0; slot < 27; ++slot) {
            const int dx = slot / 9 - 1, dy = slot / 3 % 3 - 1, dz = slot % 3 - 1;
            const int x = place.x() + dx, y = place.y() + dy, z = place.z() + dz;
            if (node && ((x | y | z) & ~kMost) == 0) {
                const int n = x << 2 * kLog2 | y << kLog2 | z;
                const auto& entry = node->getTable()[n];
                leaves[slot] = node->isChildMaskOn(n) ? entry.getChild()->buffer().data()
                                                      : constantLeaf(slot, entry.getValue());
                continue;
            }
            const openvdb::Coord origin = own.offsetBy(8 * dx, 8 * dy, 8 * dz);
            if (const auto* leaf = mAccessor.probeConstLeaf(origin)) {
                leaves[slot] = leaf->buffer().data();
            } else {
                leaves[slot] = constantLeaf(slot, mAccessor.getValue(origin));
            }
        }
        mBlock.load(leaves, mLevel);
    }

    /// @return as many times @a value as a leaf has voxels, valid until the next call for this slot.
    const ValueT* constantLeaf(int slot, ValueT value) {
        std::vector<ValueT>& leaf = mConstant[slot];
        if (leaf.empty() || leaf.front() != value) leaf.assign(TileMask::kSize, value);
        return leaf.data();
    }

    typename GridT::ConstAccessor mAccessor;
    Level mLevel;
    openvdb::Coord mTile;
    bool mLoaded = false;
    VoxelBlock mBlock; ///< of mTile
    std::array<std::vector<ValueT>, 27> mConstant;
};

} // namespace vdbtet
