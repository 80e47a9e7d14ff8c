/// @file ValueRange.h
/// The range of a grid's values, and which of them have no sign.
#pragma once

#include "Parallel.h"
#include "bits/TileMask.h"
#include "field/TreeNodes.h"
#include "simd/Isa.h"

#include <openvdb/tree/LeafManager.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// What a part of the tree has: the range of its finite values, and the others.
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
    /// @param takes  see scanValues()
    template <typename NodeT, typename Takes>
    void addTiles(const NodeT& node, const Takes& takes) {
        forEachTile(node, [&](double value, openvdb::Index slot) {
            addTile(
                value, [&] { return node.offsetToGlobalCoord(slot); }, takes);
        });
    }
    template <typename Place, typename Takes>
    void addTile(double value, const Place& place, const Takes& takes) {
        if (std::isfinite(value) || takes(place())) add(value, place);
    }
};

/// @return what the tiles and leaves have, active or not; the background is not among it.
/// @param takes  takes(origin) for a leaf, or a tile without a sign: whether to look at it
template <typename GridT, typename Takes>
ValueScan scanValues(const GridT& grid, Interrupt& interrupt, const Takes& takes) {
    using TreeT = typename GridT::TreeType;
    tbb::enumerable_thread_specific<ValueScan> scans;
    const openvdb::tree::LeafManager<const TreeT> leaves(grid.tree());
    interrupt.expectLoops(1);
    parallelRanges(std::int64_t(leaves.leafCount()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        ValueScan& scan = scans.local();
        for (std::int64_t l = begin; l < end; ++l) {
            if (takes(leaves.leaf(std::size_t(l)).origin())) scan.addLeaf(leaves.leaf(std::size_t(l)));
        }
    });
    const TreeNodes<TreeT> nodes(grid.tree());
    parallelEach(std::int64_t(nodes.lower.size()), interrupt,
                 [&](std::int64_t n) { scans.local().addTiles(*nodes.lower[n], takes); });
    parallelEach(std::int64_t(nodes.upper.size()), interrupt,
                 [&](std::int64_t n) { scans.local().addTiles(*nodes.upper[n], takes); });
    ValueScan scan;
    for (const ValueScan& part : scans) scan.add(part);
    for (auto tile = grid.tree().root().cbeginValueAll(); tile; ++tile)
        scan.addTile(
            *tile, [&] { return tile.getCoord(); }, takes);
    return scan;
}

} // namespace vdbtet
