/// @file GridField.h
/// A VDB grid as a Field: trilinear interpolation between voxel centres.
#pragma once

#include "bcc/Frame.h"
#include "field/Field.h"
#include "field/Level.h"
#include "field/Root.h"
#include "field/SurfaceTiles.h"
#include "field/VoxelBlock.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbtet {

/// @return the trilinear interpolation of corner values @a p (p[4i+2j+k] at corner (i,j,k)) at (x,y,z) in
/// [0,1]^3.
/// @details Exact at the corners, and never of the wrong sign where all corners agree.
inline double trilinear(const double (&p)[8], double x, double y, double z) {
    auto mix = [](double a, double b, double w) { return (1.0 - w) * a + w * b; };
    return mix(mix(mix(p[0], p[1], z), mix(p[2], p[3], z), y), mix(mix(p[4], p[5], z), mix(p[6], p[7], z), y),
               x);
}

/// Samples the grid at any lattice point, through an accessor.
template <typename GridT>
class TrilinearSampler final : public Field::Sampler {
public:
    TrilinearSampler(const GridT& grid, const Frame& frame, const Level& level)
        : mAccessor(grid.tree()), mFrame(frame), mLevel(level), mBackground(level.phi(grid.background())) {}

    void signs(const openvdb::Coord& tile, PaddedMask& a, PaddedMask& b) override {
        for (int x = 0; x <= 8; ++x) {
            for (int y = 0; y <= 8; ++y) {
                for (int z = 0; z <= 8; ++z) {
                    const int n = PaddedMask::bit(x, y, z), below = PaddedMask::bit(x - 1, y - 1, z - 1);
                    if (phi(position(tile, n, 0.0)) >= 0.0) a.set(n);
                    if (phi(position(tile, below, 0.5)) >= 0.0) b.set(below);
                }
            }
        }
    }

    void nearerToA(const openvdb::Coord& tile, const std::vector<ShortEdge>& edges,
                   std::uint8_t* nearer) override {
        for (const ShortEdge& e : edges) {
            const openvdb::Vec3d from = position(tile, e.vertex, 0.0), edge = vectorOf(e);
            *nearer++ = cutInFirstHalf(phi(from), phi(from + 0.5 * edge), phi(from + edge));
        }
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const std::vector<ShortEdge>& edges,
                   float* distance) override {
        for (const ShortEdge& e : edges) {
            const openvdb::Vec3d from = position(tile, e.vertex, 0.5 * lattice), edge = vectorOf(e);
            *distance++ = distanceToCut(phi(from), [&](double s) { return phi(from + s * edge); });
        }
    }

private:
    /// @param n  a vertex by PaddedMask::bit()
    static openvdb::Vec3d position(const openvdb::Coord& tile, int n, double shift) {
        return openvdb::Vec3d(8.0 * tile.x() + PaddedMask::x(n) + shift,
                              8.0 * tile.y() + PaddedMask::y(n) + shift,
                              8.0 * tile.z() + PaddedMask::z(n) + shift);
    }

    static openvdb::Vec3d vectorOf(const ShortEdge& e) {
        return openvdb::Vec3d(bcc::kShortEdges[e.direction]);
    }

    double phi(const openvdb::Vec3d& lattice) {
        const openvdb::Vec3d at = mFrame.toIndex * lattice;
        const openvdb::Vec3d low(std::floor(at.x()), std::floor(at.y()), std::floor(at.z()));
        constexpr double kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max() - 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(low[axis] >= kMin && low[axis] <= kMax)) return mBackground;
        }
        const openvdb::Coord base(int(low.x()), int(low.y()), int(low.z()));
        double p[8];
        for (int corner = 0; corner < 8; ++corner) {
            p[corner] =
                mLevel.phi(mAccessor.getValue(base.offsetBy(corner >> 2, corner >> 1 & 1, corner & 1)));
        }
        return trilinear(p, at.x() - low.x(), at.y() - low.y(), at.z() - low.z());
    }

    typename GridT::ConstAccessor mAccessor;
    Frame mFrame;
    Level mLevel;
    double mBackground;
};

/// Samples the grid where L_A is the voxel centres and tiles are leaves: no position is ever computed.
template <typename GridT>
class VoxelSampler final : public Field::Sampler {
public:
    VoxelSampler(const GridT& grid, const Level& level) : mAccessor(grid.tree()), mLevel(level) {}

    void signs(const openvdb::Coord& tile, PaddedMask& a, PaddedMask& b) override {
        load(tile);
        mBlock.signs(a, b);
    }

    void nearerToA(const openvdb::Coord& tile, const std::vector<ShortEdge>& edges,
                   std::uint8_t* nearer) override {
        load(tile);
        mBlock.nearerToA(edges, nearer);
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const std::vector<ShortEdge>& edges,
                   float* distance) override {
        load(tile);
        mBlock.cutPoints(lattice, edges, distance);
    }

private:
    using ValueT = typename GridT::ValueType;

    /// Copy the tile's voxels and a border of one from the leaves.
    void load(const openvdb::Coord& tile) {
        if (mLoaded && tile == mTile) return;
        mLoaded = true;
        mTile = tile;
        std::array<const ValueT*, 27> leaves;
        for (int slot = 0; slot < 27; ++slot) {
            const openvdb::Coord origin(8 * (tile.x() + slot / 9 - 1), 8 * (tile.y() + slot / 3 % 3 - 1),
                                        8 * (tile.z() + slot % 3 - 1));
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

template <typename GridT>
class GridField final : public Field {
public:
    /// The grid must outlive the field, and hold finite values only.
    GridField(const GridT& grid, const Frame& frame, const Level& level)
        : mGrid(grid), mFrame(frame), mLevel(level), mOnVoxels(frame.toIndex == openvdb::Mat3d::identity()) {}

    std::vector<openvdb::Coord> surfaceTiles(std::int64_t maxTiles, Interrupt& interrupt) const override {
        return tilesNearSurface(mGrid.tree(), mFrame, mLevel, maxTiles, interrupt);
    }

    std::unique_ptr<Sampler> sampler() const override {
        if (mOnVoxels) return std::make_unique<VoxelSampler<GridT>>(mGrid, mLevel);
        return std::make_unique<TrilinearSampler<GridT>>(mGrid, mFrame, mLevel);
    }

private:
    const GridT& mGrid;
    Frame mFrame;
    Level mLevel;
    bool mOnVoxels;
};

} // namespace vdbtet
