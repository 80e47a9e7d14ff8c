/// @file ValueRange.h
/// The values of a grid, all of which must have a sign.
#pragma once

#include "bits/TileMask.h"
#include "field/TreeNodes.h"
#include "simd/Isa.h"

#include <vdbtet/Errors.h>

#include <openvdb/tree/LeafManager.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

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

/// What a part of the tree has.
struct ValueScan {
    double min = std::numeric_limits<double>::infinity(), max = -min;
    std::int64_t bad = 0;
    openvdb::Coord firstBad = openvdb::Coord::max();

    template <typename Place>
    void add(double value, const Place& place) {
        if (!std::isfinite(value)) {
            ++bad;
            firstBad = std::min(firstBad, place());
            return;
        }
        min = std::min(min, value);
        max = std::max(max, value);
    }
    void add(const ValueScan& other) {
        min = std::min(min, other.min);
        max = std::max(max, other.max);
        bad += other.bad;
        firstBad = std::min(firstBad, other.firstBad);
    }

    template <typename LeafT>
    void addLeaf(const LeafT& leaf) {
        const auto* voxels = leaf.buffer().data();
        if (widenIfFinite(voxels, min, max)) return;
        for (int n = 0; n < TileMask::kSize; ++n) add(voxels[n], [&] { return leaf.offsetToGlobalCoord(n); });
    }
    template <typename NodeT>
    void addTiles(const NodeT& node) {
        forEachTile(node, [&](double value, openvdb::Index slot) {
            add(value, [&] { return node.offsetToGlobalCoord(slot); });
        });
    }
};

/// @return the least and the greatest value of the leaves, the tiles and the background, active or not.
/// @throw BadValue where one of them is NaN or infinite
template <typename GridT>
ValueRange scanValues(const GridT& grid) {
    if (!std::isfinite(grid.background())) throw BadValue("the background value is not a finite number");
    using TreeT = typename GridT::TreeType;
    tbb::enumerable_thread_specific<ValueScan> scans;
    const openvdb::tree::LeafManager<const TreeT> leaves(grid.tree());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, leaves.leafCount(), 64), [&](const auto& range) {
        ValueScan& scan = scans.local();
        for (size_t l = range.begin(); l != range.end(); ++l) scan.addLeaf(leaves.leaf(l));
    });
    const TreeNodes<TreeT> nodes(grid.tree());
    tbb::parallel_for(size_t(0), nodes.lower.size(),
                      [&](size_t n) { scans.local().addTiles(*nodes.lower[n]); });
    tbb::parallel_for(size_t(0), nodes.upper.size(),
                      [&](size_t n) { scans.local().addTiles(*nodes.upper[n]); });
    ValueScan scan;
    for (const ValueScan& part : scans) scan.add(part);
    for (auto tile = grid.tree().root().cbeginValueAll(); tile; ++tile)
        scan.add(*tile, [&] { return tile.getCoord(); });
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
