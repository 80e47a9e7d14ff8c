/// @file TrilinearProbe.h
/// The trilinear field and its gradient anywhere.
#pragma once

#include "bcc/Frame.h"
#include "field/Field.h"
#include "field/Level.h"
#include "field/Trilinear.h"

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbtet {

/// @brief Looks voxels up where they are: those who ask come to few places in each tile.
template <typename GridT>
class TrilinearProbe final : public Field::Probe {
public:
    TrilinearProbe(const GridT& grid, const Frame& frame, const Level& level)
        : mAccessor(grid.tree()), mToIndex(frame.toIndex), mToLattice(frame.toIndex.transpose()),
          mLevel(level) {}

    FieldPoint at(const openvdb::Vec3d& place) override {
        const openvdb::Vec3d at = mToIndex * place;
        const openvdb::Vec3d low(std::floor(at.x()), std::floor(at.y()), std::floor(at.z()));
        constexpr double kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max() - 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(low[axis] >= kMin && low[axis] <= kMax)) return {};
        }
        double p[8];
        corners(openvdb::Coord(int(low.x()), int(low.y()), int(low.z())), p);
        const double x = at.x() - low.x(), y = at.y() - low.y(), z = at.z() - low.z();
        const auto mix = [](double a, double b, double w) { return (1.0 - w) * a + w * b; };
        // The field on the edges along x and on the faces across it.
        const double yz[4] = {mix(p[0], p[4], x), mix(p[1], p[5], x), mix(p[2], p[6], x), mix(p[3], p[7], x)};
        const double lowX = mix(mix(p[0], p[1], z), mix(p[2], p[3], z), y),
                     highX = mix(mix(p[4], p[5], z), mix(p[6], p[7], z), y);
        const openvdb::Vec3d slope(highX - lowX, mix(yz[2], yz[3], z) - mix(yz[0], yz[1], z),
                                   mix(yz[1], yz[3], y) - mix(yz[0], yz[2], y));
        const auto range = std::minmax_element(p, p + 8);
        return {trilinear(p, x, y, z), mToLattice * slope,
                slope.length() > kLeastSlope * (*range.second - *range.first)};
    }

private:
    /// The gradient's length as a share of the differences between the voxels around it: at least 0.58 where
    /// the field is linear, and 0 in its extremes and saddles.
    static constexpr double kLeastSlope = 0.15;

    void corners(const openvdb::Coord& low, double (&p)[8]) {
        using LeafT = typename GridT::TreeType::LeafNodeType;
        const bool inOneLeaf = (low.x() & 7) != 7 && (low.y() & 7) != 7 && (low.z() & 7) != 7;
        const LeafT* leaf = inOneLeaf ? mAccessor.probeConstLeaf(low) : nullptr;
        for (int corner = 0; corner < 8; ++corner) {
            const openvdb::Coord at = low.offsetBy(corner >> 2, corner >> 1 & 1, corner & 1);
            p[corner] = mLevel.phi(leaf ? leaf->getValue(LeafT::coordToOffset(at)) : mAccessor.getValue(at));
        }
    }

    typename GridT::ConstAccessor mAccessor;
    openvdb::Mat3d mToIndex, mToLattice;
    Level mLevel;
};

} // namespace vdbtet
