/// @file GridPart.h
/// Reads a part of a grid.
#pragma once

#include "io/GridArchive.h"

#include <string>

namespace vdbtet {

/// @brief Read the grid that readGrid() would, but of its leaves only those that @a choose wants; where the
/// others are the grid has its background.
/// @throw UnsupportedGrid  also for a grid that is neither float nor double
/// @throw FileError, UnsupportedGrid as readGrid()
openvdb::GridBase::Ptr readGridPart(const std::string& path, const std::string& name,
                                    const GridArchive::ChooseLeaves& choose);

/// @return the metadata and transform of the grid that readGrid() would read
/// @throw FileError, UnsupportedGrid as readGrid()
openvdb::GridBase::Ptr readGridHead(const std::string& path, const std::string& name);

} // namespace vdbtet
