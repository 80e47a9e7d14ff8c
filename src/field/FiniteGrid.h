/// @file FiniteGrid.h
/// A grid all of whose values have a sign: the user's, or a copy with the others replaced.
#pragma once

#include "field/Level.h"
#include "field/ValueRange.h"

#include <vdbtet/Errors.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/tree/NodeManager.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace vdbtet {

/// @return the range of the values of a grid, with its background.
/// @throw BadValue where one of them is NaN or infinite
inline ValueRange requireFinite(const ValueScan& scan, double background, const openvdb::GridBase& grid) {
    const bool badBackground = !std::isfinite(background);
    if (scan.bad == 0 && !badBackground)
        return {std::min(scan.min, background), std::max(scan.max, background)};
    std::ostringstream message;
    if (scan.bad > 0) {
        message << scan.bad << " voxels or tiles hold NaN or infinite values, the first at " << scan.firstBad
                << ", in world space " << grid.indexToWorld(scan.firstBad);
    }
    if (badBackground)
        message << (scan.bad > 0 ? ", and so does the background" : "the background is NaN or infinite");
    message << "; such values have no sign: mesh them as inside or outside (nan), or replace them";
    throw BadValue(message.str());
}

/// @brief What the values of a grid that have no sign are taken for.
/// @details The same for signs, cut points, gradients and fields: they are replaced in the tree.
template <typename GridT>
class Replacement {
public:
    /// @param scan  of all values of the grid
    /// @throw BadValue where a value is NaN or infinite, and @a nan is Nan::Error
    Replacement(const ValueScan& scan, const GridT& grid, const Level& level, Nan nan) {
        const double background = grid.background();
        const bool badBackground = !std::isfinite(background);
        mCount = scan.bad + (badBackground ? 1 : 0);
        if (mCount == 0 || nan == Nan::Error) {
            mValues = requireFinite(scan, background, grid);
            return;
        }
        const double depth = badBackground ? depthOf(scan, level) : -level.phi(background);
        const ValueT outside = valueAt(level, -depth), inside = valueAt(level, depth);
        mBackground = badBackground ? outside : grid.background();
        mWith = nan == Nan::Inside ? inside : outside;
        mValues = {scan.min, scan.max};
        for (const double value : {mWith, mBackground})
            mValues = {std::min(mValues.min, value), std::max(mValues.max, value)};
    }

    /// How many values are replaced.
    std::int64_t count() const { return mCount; }
    /// Of the leaves, the tiles and the background, active or not, after that.
    const ValueRange& values() const { return mValues; }

    /// @param grid  the one that was scanned, or a part or a copy of it
    void apply(GridT& grid) const {
        if (mCount == 0) return;
        grid.tree().root().setBackground(mBackground, /*updateChildNodes=*/false);
        const Replace replace{mWith};
        openvdb::tree::NodeManager<typename GridT::TreeType>(grid.tree()).foreachTopDown(replace);
    }

private:
    using ValueT = typename GridT::ValueType;

    struct Replace {
        ValueT with;

        template <typename NodeT>
        void operator()(NodeT& node) const {
            for (auto value = node.beginValueAll(); value; ++value) {
                if (!std::isfinite(*value)) value.setValue(with);
            }
        }
    };

    /// How far the good values go on either side of the isovalue.
    static double depthOf(const ValueScan& scan, const Level& level) {
        if (!(scan.min <= scan.max)) return 1.0;
        const double depth = std::max(std::abs(level.phi(scan.min)), std::abs(level.phi(scan.max)));
        return depth > 0.0 ? depth : 1.0;
    }

    /// @return a value of the field @a phi, or nearly, whose sign is right in any case.
    static ValueT valueAt(const Level& level, double phi) {
        constexpr double kMost = double(std::numeric_limits<ValueT>::max());
        const double exact = level.insideIsBelow ? level.isovalue - phi : level.isovalue + phi;
        auto value = ValueT(std::min(std::max(exact, -kMost), kMost));
        const ValueT farther = level.insideIsBelow == (phi > 0.0) ? -std::numeric_limits<ValueT>::max()
                                                                  : std::numeric_limits<ValueT>::max();
        while ((level.phi(value) >= 0.0) != (phi > 0.0) && value != farther)
            value = std::nextafter(value, farther);
        return value;
    }

    std::int64_t mCount = 0;
    ValueRange mValues{};
    ValueT mWith{}, mBackground{};
};

/// @brief Looks at all values; so what reads the grid afterwards need not think of NaN.
/// @details Values that are replaced are in a copy of the whole tree, so readers of good grids pay nothing.
template <typename GridT>
class FiniteGrid {
public:
    /// @param grid  must outlive this
    /// @param interrupt  after a stop this is useless
    /// @throw BadValue where a value is NaN or infinite, and @a nan is Nan::Error
    FiniteGrid(const GridT& grid, const Level& level, Nan nan, Interrupt& interrupt) : mOriginal(grid) {
        const ValueScan scan = scanValues(grid, interrupt, [](const auto&) { return true; });
        if (interrupt.stopped()) return;
        const Replacement<GridT> replacement(scan, grid, level, nan);
        mReplaced = replacement.count();
        mValues = replacement.values();
        if (mReplaced == 0) return;
        mCopy = grid.deepCopy();
        replacement.apply(*mCopy);
    }

    const GridT& grid() const { return mCopy ? *mCopy : mOriginal; }
    /// Of the leaves, the tiles and the background, active or not.
    const ValueRange& values() const { return mValues; }
    std::int64_t replaced() const { return mReplaced; }
    /// Of the grid, and of the copy if there is one, bytes.
    std::int64_t memory() const {
        return std::int64_t(mOriginal.memUsage()) + (mCopy ? std::int64_t(mCopy->memUsage()) : 0);
    }

private:
    const GridT& mOriginal;
    typename GridT::Ptr mCopy; ///< or null
    ValueRange mValues{};
    std::int64_t mReplaced = 0;
};

} // namespace vdbtet
