/// @file CommandLine.h
/// What the user of vdb_tet asks for.
#pragma once

#include <vdbtet/MeshFile.h>
#include <vdbtet/VolumeToTets.h>

#include <optional>
#include <string>
#include <vector>

/// Of all jobs, with placeholders in the names of files; of one of them (Plan.h), without.
struct CommandLine {
    std::vector<std::string> inputs; ///< files, or patterns for frames
    std::string frames;              ///< a list; empty: inputs are files
    bool allGrids = false;
    int jobs = 0; ///< at once; 0: as many as fit
    bool resume = false, failFast = false;
    std::string log; ///< JSON lines; empty: none

    std::string in;     ///< of one job
    std::string out;    ///< may be empty in a dry run
    std::string format; ///< of OUT; empty: by its extension
    vdbtet::FormatOptions formatOptions;
    std::string surface;                  ///< where to write the boundary; empty: nowhere
    bool splitSurface = false;            ///< so that each fan of its triangles has its own points
    std::string name;                     ///< of the grid; empty: the only one
    std::optional<double> voxelSize;      ///< for surfaces; default: by their size
    std::vector<std::string> sample;      ///< grids whose values the points carry; "all" for all others
    std::vector<std::string> sampleCells; ///< the same for the tets
    std::string fieldsFrom;               ///< the file that holds them; empty: IN
    bool boundaryFlag = false, minDihedral = false, distance = false; ///< fields of the mesh itself
    std::optional<double> distanceWidth;
    double scale = 1.0;
    std::string report; ///< JSON, or a page if it ends in .html; empty: none
    vdbtet::Options options;
    int threads = 0; ///< 0: all
    bool quiet = false;
    bool dryRun = false;

    bool hasFields() const {
        return !sample.empty() || !sampleCells.empty() || boundaryFlag || minDihedral || distance;
    }
};

/// @param ranks  of vdb_tet_mpi, which knows .pvtu files, too
/// @return nothing when help or the version was asked for, and has been printed
/// @throw UsageError, vdbtet::BadOption, and vdbtet::FileError where that cannot be printed
std::optional<CommandLine> parseCommandLine(int argc, const char* const* argv, bool ranks = false);

/// Whether OUT is a .pvtu file.
bool isPvtu(const CommandLine& line);
