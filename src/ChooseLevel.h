/// @file ChooseLevel.h
/// What is inside: the isovalue, and the side of it.
#pragma once

#include "field/Level.h"
#include "field/ValueRange.h"

#include <vdbtet/VolumeToTets.h>

#include <string>

namespace vdbtet {

/// @return the grid's name for messages
std::string quoted(const openvdb::GridBase& grid);

/// @brief What kind of field the grid holds: the isovalue, and on which side of it the inside lies.
/// @param report  gets them, too
/// @throw UnboundedInside
/// @throw BadValue where a background that is NaN or infinite is all that could tell the side
Level chooseLevel(const openvdb::GridBase& grid, double background, const Options& options, Report& report);

/// @throw NoSurface where no value is inside
void requireInside(const ValueRange& values, const Level& level);

} // namespace vdbtet
