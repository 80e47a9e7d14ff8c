/// @file Summary.h
/// What vdb_tet tells of a run: a few lines for people, JSON for programs.
#pragma once

#include "CommandLine.h"

#include <vdbtet/VolumeToTets.h>

#include <cstdint>
#include <string>
#include <vector>

struct Summary {
    vdbtet::Report report; ///< with the reading as its first stage
    std::string gridType;  ///< such as "float, level set"
    std::string surface;   ///< what it was made from, or empty
    std::vector<std::string> warnings;
    double seconds = 0.0;          ///< reading and meshing
    std::uint64_t bytes = 0;       ///< size of the mesh file, also of the one a dry run does not write
    std::int64_t surfaceSplit = 0; ///< points that were doubled in the surface file alone
};

/// Such as "1.5 MB".
std::string humanSize(std::uint64_t bytes);

std::string asText(const CommandLine& line, const Summary& summary);
std::string asJson(const CommandLine& line, const Summary& summary);
