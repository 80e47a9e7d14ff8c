/// @file ReportPage.h
/// The report of a run as a page for browsers, with a picture of the mesh.
#pragma once

#include "Summary.h"
#include "io/OutputFile.h"

#include <openvdb/Grid.h>
#include <openvdb/util/NullInterrupter.h>

#include <string>

/// @return whether a report of this name is a page: .html or .htm
bool isReportPage(const std::string& path);

/// @throw UsageError where this program was built without three.js, which pages need
void requireReportPages();

/// @brief Write a page that needs neither other files nor a network, and commit it.
/// @param grid  the grid that was meshed
/// @return false, with nothing written, when interrupted
/// @details The page has all that asJson() has, what the file says of itself and of the grid, and a mesh to
/// look at, which is at most kMostTetsShown in size: so is the page, at most some 30 MB.
/// @throw vdbtet::FileError
bool writeReportPage(vdbtet::OutputFile& file, const CommandLine& line, const Summary& summary,
                     const openvdb::GridBase& grid, openvdb::util::NullInterrupter* interrupter);
