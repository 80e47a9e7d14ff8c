/// @file Info.h
/// vdb_tet info: what a file holds, and what a mesh of it would take.
#pragma once

#include <openvdb/util/NullInterrupter.h>

#include <nlohmann/json.hpp>

#include <string>

/// Do what the command line after "info" says.
/// @return the exit code
/// @throw UsageError
int info(int argc, const char* const* argv);

/// @brief List the grids of a file, and count the mesh that vdb_tet would make.
/// @details Runs the stages near the surface, so the numbers of points and tets and the sizes of files are
/// exact.
/// @param name         of the grid to count for; empty: the one that would be meshed
/// @param interrupter  once it has said stop, counts are missing
/// @return numbers as JSON; where there is nothing to mesh, "obstacle" says why
/// @throw vdbtet::Error where the file cannot be read
nlohmann::ordered_json describeFile(const std::string& path, const std::string& name,
                                    openvdb::util::NullInterrupter& interrupter);

/// The same for people.
std::string asText(const nlohmann::ordered_json& file);
