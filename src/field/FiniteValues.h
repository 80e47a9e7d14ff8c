/// @file FiniteValues.h
/// Refuses grids whose values have no sign.
#pragma once

#include "bits/TileMask.h"

#include <vdbtet/Errors.h>

#include <openvdb/tree/LeafManager.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vdbtet {

/// @throw BadValue where a leaf, a tile or the background holds NaN or an infinity
template <typename GridT>
void requireFinite(const GridT& grid) {
    struct Found {
        std::int64_t count = 0;
        openvdb::Coord first = openvdb::Coord::max();

        void add(const openvdb::Coord& at) {
            ++count;
            first = std::min(first, at);
        }
    };
    using TreeT = typename GridT::TreeType;
    const openvdb::tree::LeafManager<const TreeT> leaves(grid.tree());
    Found found = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, leaves.leafCount(), 64), Found(),
        [&](const tbb::blocked_range<size_t>& range, Found part) {
            for (size_t l = range.begin(); l != range.end(); ++l) {
                const auto* data = leaves.leaf(l).buffer().data();
                for (int n = 0; n < TileMask::kSize; ++n) {
                    if (!std::isfinite(data[n])) part.add(leaves.leaf(l).offsetToGlobalCoord(n));
                }
            }
            return part;
        },
        [](Found a, const Found& b) {
            a.count += b.count;
            a.first = std::min(a.first, b.first);
            return a;
        });
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(tile.getLeafDepth() - 1);
    for (; tile; ++tile) {
        if (!std::isfinite(tile.getValue())) found.add(tile.getCoord());
    }
    if (!std::isfinite(grid.background())) throw BadValue("the background value is not a finite number");
    if (found.count != 0) {
        std::ostringstream message;
        message << found.count << " voxels or tiles hold NaN or infinite values, the first at " << found.first
                << "; such values have no sign, replace them first";
        throw BadValue(message.str());
    }
}

} // namespace vdbtet
