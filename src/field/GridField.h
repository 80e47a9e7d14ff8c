/// @file GridField.h
/// A VDB grid as a Field: trilinear interpolation between voxel centres.
#pragma once

#include "bcc/Frame.h"
#include "field/Field.h"
#include "field/Level.h"
#include "field/Root.h"
#include "field/SurfaceTiles.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbtet {

/// The field along the line from a corner of a voxel-centred cube to its centre, where trilinear
/// interpolation is a cubic.
class Diagonal {
public:
    /// @param p  the eight corner values, p[4i+2j+k] at corner (i,j,k); the line starts at p[0]
    explicit Diagonal(const double (&p)[8])
        : mBernstein{p[0], (p[1] + p[2] + p[4]) / 3.0, (p[3] + p[5] + p[6]) / 3.0, p[7]} {}

    /// @param t  0 at the corner, 1 at the centre
    double operator()(double t) const {
        const double s = 0.5 * t, r = 1.0 - s;
        return r * r * (r * mBernstein[0] + 3.0 * s * mBernstein[1]) +
               s * s * (3.0 * r * mBernstein[2] + s * mBernstein[3]);
    }

private:
    double mBernstein[4];
};

/// @return the trilinear interpolation of corner values @a p (p[4i+2j+k] at corner (i,j,k)) at (x,y,z) in
/// [0,1]^3.
/// @details Exact at the corners, and never of the wrong sign where all corners agree.
inline double trilinear(const double (&p)[8], double x, double y, double z) {
    auto mix = [](double a, double b, double w) { return (1.0 - w) * a + w * b; };
    return mix(mix(mix(p[0], p[1], z), mix(p[2], p[3], z), y), mix(mix(p[4], p[5], z), mix(p[6], p[7], z), y),
               x);
}

/// The same at the centre of the cube.
inline double centreValue(const double (&p)[8]) {
    return 0.125 * (((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7])));
}

/// Samples the grid at any lattice point, through an accessor.
template <typename GridT>
class TrilinearSampler final : public Field::Sampler {
public:
    TrilinearSampler(const GridT& grid, const Frame& frame, const Level& level)
        : mAccessor(grid.tree()), mFrame(frame), mLevel(level), mBackground(level.phi(grid.background())) {}

    TileSigns signs(const openvdb::Coord& tile) override {
        TileSigns signs;
        for (int lattice = 0; lattice < 2; ++lattice) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                if (phi(position(tile, n, 0.5 * lattice)) >= 0.0) signs[lattice].set(n);
            }
        }
        return signs;
    }

    EdgeMasks nearerToA(const openvdb::Coord& tile, const EdgeMasks& cut) override {
        EdgeMasks nearer;
        for (int d = 0; d < bcc::kDirections; ++d) {
            const openvdb::Vec3d edge = shortEdge(d);
            cut[d].forEach([&](int n) {
                const openvdb::Vec3d from = position(tile, n, 0.0);
                if (cutInFirstHalf(phi(from), phi(from + 0.5 * edge), phi(from + edge))) nearer[d].set(n);
            });
        }
        return nearer;
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const EdgeMasks& edges,
                   float* distance) override {
        for (int d = 0; d < bcc::kDirections; ++d) {
            const openvdb::Vec3d edge = shortEdge(d);
            edges[d].forEach([&](int n) {
                const openvdb::Vec3d from = position(tile, n, 0.5 * lattice);
                *distance++ = distanceToCut(phi(from), [&](double s) { return phi(from + s * edge); });
            });
        }
    }

private:
    static openvdb::Vec3d position(const openvdb::Coord& tile, int n, double shift) {
        return openvdb::Vec3d(8.0 * tile.x() + (n >> 6) + shift, 8.0 * tile.y() + (n >> 3 & 7) + shift,
                              8.0 * tile.z() + (n & 7) + shift);
    }

    static openvdb::Vec3d shortEdge(int d) {
        return openvdb::Vec3d(0.5 * bcc::sign(d, 0), 0.5 * bcc::sign(d, 1), 0.5 * bcc::sign(d, 2));
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

    TileSigns signs(const openvdb::Coord& tile) override {
        load(tile);
        TileSigns signs;
        for (int n = 0; n < TileMask::kSize; ++n) {
            const int x = n >> 6, y = n >> 3 & 7, z = n & 7;
            if (value(x, y, z) >= 0.0) signs[bcc::A].set(n);
            double p[8];
            corners(x, y, z, 7, p);
            if (centreValue(p) >= 0.0) signs[bcc::B].set(n);
        }
        return signs;
    }

    EdgeMasks nearerToA(const openvdb::Coord& tile, const EdgeMasks& cut) override {
        load(tile);
        EdgeMasks nearer;
        for (int d = 0; d < bcc::kDirections; ++d) {
            cut[d].forEach([&](int n) {
                double p[8];
                corners(n >> 6, n >> 3 & 7, n & 7, d, p);
                const Diagonal phi(p);
                if (cutInFirstHalf(p[0], phi(0.5), phi(1.0))) nearer[d].set(n);
            });
        }
        return nearer;
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const EdgeMasks& edges,
                   float* distance) override {
        load(tile);
        for (int d = 0; d < bcc::kDirections; ++d) {
            // The voxel at the edge's L_A end, and the direction from there.
            const bcc::Step step = lattice == bcc::A ? bcc::Step{0, 0, 0} : bcc::shortEdge(bcc::B, d);
            const int fromA = lattice == bcc::A ? d : bcc::opposite(d);
            edges[d].forEach([&](int n) {
                double p[8];
                corners((n >> 6) + step.x, (n >> 3 & 7) + step.y, (n & 7) + step.z, fromA, p);
                const Diagonal phi(p);
                *distance++ = lattice == bcc::A
                                  ? distanceToCut(p[0], phi)
                                  : distanceToCut(centreOf(p, fromA), [&](double s) { return phi(1.0 - s); });
            });
        }
    }

private:
    double value(int x, int y, int z) const { return mValues[((x + 1) * 10 + y + 1) * 10 + z + 1]; }

    /// The corners of the cube at voxel (x,y,z) on its side in @a direction; p[0] is that voxel's.
    void corners(int x, int y, int z, int direction, double (&p)[8]) const {
        const int sx = bcc::sign(direction, 0), sy = bcc::sign(direction, 1), sz = bcc::sign(direction, 2);
        for (int corner = 0; corner < 8; ++corner) {
            p[corner] = value(x + (corner >> 2) * sx, y + (corner >> 1 & 1) * sy, z + (corner & 1) * sz);
        }
    }

    /// The value at the centre of corners() in @a direction, summed in the order of signs(): else its sign
    /// could differ.
    static double centreOf(const double (&p)[8], int direction) {
        double q[8];
        for (int corner = 0; corner < 8; ++corner) q[corner] = p[corner ^ bcc::opposite(direction)];
        return centreValue(q);
    }

    /// Copy the tile's voxels and a border of one from the leaves.
    void load(const openvdb::Coord& tile) {
        if (mLoaded && tile == mTile) return;
        mLoaded = true;
        mTile = tile;
        for (int slot = 0; slot < 27; ++slot) {
            const int step[3] = {slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1};
            const openvdb::Coord origin(8 * (tile.x() + step[0]), 8 * (tile.y() + step[1]),
                                        8 * (tile.z() + step[2]));
            const auto* leaf = mAccessor.probeConstLeaf(origin);
            const auto* data = leaf ? leaf->buffer().data() : nullptr;
            const double constant = data ? 0.0 : mLevel.phi(mAccessor.getValue(origin));
            auto first = [](int s) { return s < 0 ? -1 : s > 0 ? 8 : 0; };
            auto last = [](int s) { return s < 0 ? -1 : s > 0 ? 8 : 7; };
            for (int x = first(step[0]); x <= last(step[0]); ++x) {
                for (int y = first(step[1]); y <= last(step[1]); ++y) {
                    double* row = mValues + ((x + 1) * 10 + y + 1) * 10 + 1;
                    for (int z = first(step[2]); z <= last(step[2]); ++z) {
                        row[z] = data ? mLevel.phi(data[TileMask::bit(x & 7, y & 7, z & 7)]) : constant;
                    }
                }
            }
        }
    }

    typename GridT::ConstAccessor mAccessor;
    Level mLevel;
    openvdb::Coord mTile;
    bool mLoaded = false;
    double mValues[1000]; ///< of mTile
};

template <typename GridT>
class GridField final : public Field {
public:
    /// The grid must outlive the field, and hold finite values only.
    GridField(const GridT& grid, const Frame& frame, const Level& level)
        : mGrid(grid), mFrame(frame), mLevel(level), mOnVoxels(frame.toIndex == openvdb::Mat3d::identity()) {}

    std::vector<openvdb::Coord> surfaceTiles(std::int64_t maxTiles, Interrupt& interrupt) const override {
        return tilesNearSurface(mGrid.tree(), mFrame, mLevel, kClearance, maxTiles, interrupt);
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
