/// @file TrilinearSampler.h
/// Trilinear interpolation at lattice points that lie anywhere between the voxels.
#pragma once

#include "bcc/Frame.h"
#include "field/Brick.h"
#include "field/Field.h"
#include "field/GradientRoot.h"
#include "field/Level.h"
#include "field/Root.h"
#include "field/Trilinear.h"

#include <openvdb/tree/ValueAccessor.h>

#include <cmath>
#include <limits>

namespace vdbtet {

/// Samples the grid at any lattice point.
template <typename GridT>
class TrilinearSampler final : public Field::Sampler {
public:
    TrilinearSampler(const GridT& grid, const Frame& frame, const Level& level)
        : mAccessor(grid.tree()), mFrame(frame), mLevel(level), mBackground(level.phi(grid.background())) {}

    void signs(const openvdb::Coord& tile, PaddedMask& a, PaddedMask& b) override {
        load(tile);
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

    void nearerToA(const openvdb::Coord& tile, const PaddedEdgeMasks& edges, double tau,
                   PaddedEdgeMasks& nearer) override {
        load(tile);
        for (int d = 0; d < bcc::kDirections; ++d) {
            const openvdb::Vec3d edge(bcc::kShortEdges[d]);
            edges[d].forEach([&](int n) {
                const openvdb::Vec3d from = position(tile, n, 0.0);
                const double first = phi(from), reach = reachOf(first, tau);
                nearer[d].set(n, cutInFirstPart(first, phi(from + reach * edge), phi(from + edge)));
            });
        }
    }

    void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice, const std::vector<ShortEdge>& edges,
                   double tau, float* distance) override {
        load(tile);
        for (const ShortEdge& e : edges) {
            const openvdb::Vec3d from = position(tile, e.vertex, 0.5 * lattice),
                                 edge(bcc::kShortEdges[e.direction]);
            const double near = phi(from);
            *distance++ = distanceToCut(near, reachOf(near, e.halved ? 0.5 : tau),
                                        [&](double s) { return phi(from + s * edge); });
        }
    }

    void alongGradient(const openvdb::Coord& tile, bcc::Lattice lattice,
                       const std::vector<std::uint16_t>& vertices, const std::vector<double>& reach,
                       openvdb::Vec3d* offsets) override {
        load(tile);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const openvdb::Vec3d from = position(tile, vertices[i], 0.5 * lattice);
            double around[bcc::kDirections];
            for (int d = 0; d < bcc::kDirections; ++d)
                around[d] = phi(from + openvdb::Vec3d(bcc::kShortEdges[d]));
            offsets[i] = rootAlongGradient(phi(from), around, reach[i],
                                           [&](const openvdb::Vec3d& offset) { return phi(from + offset); });
        }
    }

private:
    /// @param n  a vertex by PaddedMask::bit()
    static openvdb::Vec3d position(const openvdb::Coord& tile, int n, double shift) {
        return openvdb::Vec3d(8.0 * tile.x() + PaddedMask::x(n) + shift,
                              8.0 * tile.y() + PaddedMask::y(n) + shift,
                              8.0 * tile.z() + PaddedMask::z(n) + shift);
    }

    /// Copy the voxels around a tile, if they are not so many that looking some up is cheaper.
    void load(const openvdb::Coord& tile) {
        if (mLoaded && tile == mTile) return;
        mLoaded = true;
        mTile = tile;
        // The vertices, and the ends of their edges, are at -1/2 to 8. One voxel more is for rounding.
        constexpr double kHalf = 4.25, kCentre = 3.75;
        const openvdb::Vec3d centre =
            mFrame.toIndex *
            openvdb::Vec3d(8.0 * tile.x() + kCentre, 8.0 * tile.y() + kCentre, 8.0 * tile.z() + kCentre);
        double size = 1.0;
        openvdb::Vec3d low, high;
        for (int axis = 0; axis < 3; ++axis) {
            double half = 1.0;
            for (int j = 0; j < 3; ++j) half += kHalf * std::abs(mFrame.toIndex(axis, j));
            low[axis] = std::floor(centre[axis] - half);
            high[axis] = std::floor(centre[axis] + half) + 1.0;
            size *= high[axis] - low[axis] + 1.0;
            constexpr double kFarthest = 2e9; // of coordinates that fit 32 bits
            if (!(low[axis] > -kFarthest && high[axis] < kFarthest)) size = kMostVoxels + 1.0;
        }
        mHasBrick = size <= kMostVoxels;
        if (!mHasBrick) return;
        mBrick.load(mAccessor, openvdb::CoordBBox(int(low.x()), int(low.y()), int(low.z()), int(high.x()),
                                                  int(high.y()), int(high.z())));
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
        const bool found =
            mHasBrick && mBrick.corners(base, p, [&](double value) { return mLevel.phi(value); });
        for (int corner = 0; corner < 8 && !found; ++corner) {
            p[corner] =
                mLevel.phi(mAccessor.getValue(base.offsetBy(corner >> 2, corner >> 1 & 1, corner & 1)));
        }
        return trilinear(p, at.x() - low.x(), at.y() - low.y(), at.z() - low.z());
    }

    /// A tile takes some 2000 samples, each of 8 voxels.
    static constexpr double kMostVoxels = 50000;

    typename GridT::ConstAccessor mAccessor;
    Frame mFrame;
    Level mLevel;
    double mBackground;
    openvdb::Coord mTile;
    bool mLoaded = false, mHasBrick = false;
    Brick<GridT> mBrick; ///< around mTile
};

} // namespace vdbtet
