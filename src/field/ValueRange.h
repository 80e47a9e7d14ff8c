/// @file ValueRange.h
/// The values of a grid, all of which must have a sign.
#pragma once

#include "bits/TileMask.h"
#include "simd/Isa.h"

#include <vdbtet/Errors.h>

#include <openvdb/tree/LeafManager.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace vdbtet {

struct ValueRange {
    double min, max;
};

/// @return whether all 512 voxels of a leaf are finite; widens @a min and @a max to hold them if so.
template <typename T>
bool widenIfFinite(const T* voxels, double& min, double& max) {
    constexpr int kLanes = 64;
    static_assert(TileMask::kSize % kLanes == 0, "lanes must fill a leaf");
    constexpr T kLargest = std::numeric_limits<T>::max();
    T least[kLanes], most[kLanes];
    bool finite = true;
    runOn(bestIsa(), [&]() VDBTET_KERNEL {
        for (int i = 0; i < kLanes; ++i) least[i] = most[i] = voxels[i];
        int bad = 0;
        for (int n = 0; n < TileMask::kSize; n += kLanes) {
            for (int i = 0; i < kLanes; ++i) {
                const T value = voxels[n + i];
                bad |= std::abs(value) <= kLargest ? 0 : 1; // true of NaN, too
                least[i] = value < least[i] ? value : least[i];
                most[i] = most[i] < value ? value : most[i];
            }
        }
        finite = bad == 0;
    });
    if (!finite) return false;
    min = std::min(min, double(*std::min_element(least, least + kLanes)));
    max = std::max(max, double(*std::max_element(most, most + kLanes)));
    return true;
}

/// @return the least and the greatest value of the leaves, the tiles and the background, active or not.
/// @throw BadValue where one of them is NaN or infinite
template <typename GridT>
ValueRange scanValues(const GridT& grid) {
    struct Scan {
        double min = std::numeric_limits<double>::infinity(), max = -min;
        std::int64_t bad = 0;
        openvdb::Coord firstBad = openvdb::Coord::max();

        void add(double value, const openvdb::Coord& at) {
            if (!std::isfinite(value)) {
                ++bad;
                firstBad = std::min(firstBad, at);
                return;
            }
            min = std::min(min, value);
            max = std::max(max, value);
        }
    };
    if (!std::isfinite(grid.background())) throw BadValue("the background value is not a finite number");
    using TreeT = typename GridT::TreeType;
    const openvdb::tree::LeafManager<const TreeT> leaves(grid.tree());
    Scan scan = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, leaves.leafCount(), 64), Scan(),
        [&](const tbb::blocked_range<size_t>& range, Scan part) {
            for (size_t l = range.begin(); l != range.end(); ++l) {
                const auto* data = leaves.leaf(l).buffer().data();
                if (widenIfFinite(data, part.min, part.max)) continue;
                for (int n = 0; n < TileMask::kSize; ++n)
                    part.add(data[n], leaves.leaf(l).offsetToGlobalCoord(n));
            }
            return part;
        },
        [](Scan a, const Scan& b) {
            a.min = std::min(a.min, b.min);
            a.max = std::max(a.max, b.max);
            a.bad += b.bad;
            a.firstBad = std::min(a.firstBad, b.firstBad);
            return a;
        });
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(tile.getLeafDepth() - 1);
    for (; tile; ++tile) scan.add(tile.getValue(), tile.getCoord());
    if (scan.bad != 0) {
        std::ostringstream message;
        message << scan.bad << " voxels or tiles hold NaN or infinite values, the first at " << scan.firstBad
                << "; such values have no sign, replace them first";
        throw BadValue(message.str());
    }
    const double background = grid.background();
    return {std::min(scan.min, background), std::max(scan.max, background)};
}

} // namespace vdbtet
