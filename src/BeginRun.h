/// @file BeginRun.h
/// What is asked of a run, before the grid's values are looked at.
#pragma once

#include "bcc/Frame.h"
#include "optimize/Optimize.h"

#include <vdbtet/VolumeToTets.h>

#include <openvdb/Grid.h>

#include <optional>

namespace vdbtet {

/// @brief Check the options and place the lattice.
/// @param grid    its name and transform
/// @param report  gets what is asked for
/// @throw BadOption, UnsupportedGrid
Frame beginRun(const openvdb::GridBase& grid, const Options& options, Report& report);

/// @return the limit of edges as a number of cells, if there is one.
inline std::optional<double> mostCells(const Options& options, const Frame& frame) {
    if (!options.maxSize) return std::nullopt;
    return *options.maxSize / frame.spacing;
}

/// @return what optimisation is to reach.
/// @pre Options::optimize is set
OptimizeOptions optimizeGoals(const Options& options, const Report& report);

} // namespace vdbtet
