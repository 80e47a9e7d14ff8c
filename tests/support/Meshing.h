/// @file Meshing.h
/// A mesh together with the report of its run.
#pragma once

#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <string>

namespace vdbtet::test {

struct Meshed {
    TetMesh mesh;
    Report report;
};

inline Meshed meshOf(const openvdb::GridBase& grid, const Options& options = {}) {
    Meshed result;
    result.report = volumeToTets(grid, result.mesh, options);
    return result;
}

/// @return what the grid is refused with, or nothing where it is meshed.
template <typename Exception>
std::string refusal(const openvdb::GridBase& grid, const Options& options = {}) {
    try {
        meshOf(grid, options);
    } catch (const Exception& error) {
        return error.what();
    }
    return "";
}

inline Options atVoxels(double voxels, int tiger = 2) {
    Options options;
    options.voxels = voxels;
    options.tiger = tiger;
    return options;
}

/// Without repair, which breaks ties by the place in the lattice, and doubles points.
inline Options raw(Options options = {}) {
    options.boundary = Boundary::Raw;
    return options;
}

} // namespace vdbtet::test
