/// @file Partition.h
/// Which rank does which tiles.
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace vdbtet::mpi {

/// @brief Cuts space into as many parts as there are ranks, of equal work, along a curve that fills it.
/// @details The curve is Morton's. So parts are compact, but no boxes. A part is known of any place, that has
/// work or not.
class CurvePartition {
public:
    /// A place, and how much work is there.
    using Work = std::pair<openvdb::Coord, std::int64_t>;

    CurvePartition(const std::vector<Work>& work, int parts);

    int operator()(const openvdb::Coord& place) const;

private:
    std::uint64_t keyOf(const openvdb::Coord& place) const;

    openvdb::CoordBBox mBox;            ///< of all places with work
    int mShift = 0;                     ///< places as near as 2^shift have one key
    std::vector<std::uint64_t> mStarts; ///< of each part but the first, the least key
};

} // namespace vdbtet::mpi
