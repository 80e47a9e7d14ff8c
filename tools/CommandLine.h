/// @file CommandLine.h
/// What the user of vdb_tet asks for.
#pragma once

#include <vdbtet/MeshFile.h>
#include <vdbtet/VolumeToTets.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// The command line makes no sense; exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct CommandLine {
    std::string in;
    std::string out;    ///< may be empty in a dry run
    std::string format; ///< of OUT; empty: by its extension
    vdbtet::FormatOptions formatOptions;
    std::string surface;                  ///< where to write the boundary; empty: nowhere
    std::string name;                     ///< of the grid; empty: the only one
    std::vector<std::string> sample;      ///< grids whose values the points carry; "all" for all others
    std::vector<std::string> sampleCells; ///< the same for the tets
    std::string fieldsFrom;               ///< the file that holds them; empty: IN
    bool boundaryFlag = false, minDihedral = false, distance = false; ///< fields of the mesh itself
    std::optional<double> distanceWidth;
    double scale = 1.0;
    std::string report; ///< JSON file; empty: none
    vdbtet::Options options;
    int threads = 0; ///< 0: all
    bool quiet = false;
    bool dryRun = false;

    bool hasFields() const {
        return !sample.empty() || !sampleCells.empty() || boundaryFlag || minDihedral || distance;
    }
};

/// @return nothing when help or the version was asked for, and has been printed
/// @throw UsageError
std::optional<CommandLine> parseCommandLine(int argc, const char* const* argv);
