/// @file BeginRun.cc
/// The limits of the options.
#include "BeginRun.h"

#include <vdbtet/Errors.h>

#include <cmath>

namespace vdbtet {

namespace {

/// Tiles are numbered in 32 bits; that many would take 1 TB.
constexpr std::int64_t kMostSurfaceTiles = std::int64_t(1) << 30;

void checkOptions(const Options& options) {
    if (options.tiger < 1 || options.tiger > 3) throw BadOption("the TIGER version must be 1, 2 or 3");
    if (options.tau && options.tiger != 3)
        throw BadOption("a threshold tau is given, which only version 3 of the method has");
    if (options.tau && !(*options.tau >= 0.5 && *options.tau <= 0.8))
        throw BadOption("the threshold tau must be from 0.5 to 0.8");
    if (options.isovalue && !std::isfinite(*options.isovalue))
        throw BadOption("the isovalue must be a finite number");
    if (options.maxSize && !options.grade)
        throw BadOption("a maximal size is given, but the inside is not to be graded");
    if (options.optimize && !(*options.optimize >= 1.0 && *options.optimize <= 38.0))
        throw BadOption("the angle to reach by optimisation must be from 1 to 38 degrees");
    if (options.sweeps < 1 || options.sweeps > 1000)
        throw BadOption("the number of sweeps must be from 1 to 1000");
    if (options.maxSurfaceTiles < 1 || options.maxSurfaceTiles > kMostSurfaceTiles) {
        throw BadOption("the limit on surface tiles must be from 1 to 2^30");
    }
    if (options.maxTets < 1) throw BadOption("the limit on tets must be at least 1");
    if (options.maxMemory && *options.maxMemory < 1)
        throw BadOption("the limit on memory must be a positive number of bytes");
}

/// How far points may be off the surface after optimisation, in voxels: half of what is promised.
constexpr double kOffSurface = 0.5e-3;

} // namespace

Frame beginRun(const openvdb::GridBase& grid, const Options& options, Report& report) {
    checkOptions(options);
    report.gridName = grid.getName();
    report.tiger = options.tiger;
    report.voxelSize = shortestVoxelEdge(grid.transform());
    report.spacing = options.spacing.value_or(options.voxels * report.voxelSize);
    const Frame frame = makeFrame(grid.transform(), report.spacing);
    if (options.maxSize && !(*options.maxSize >= report.spacing)) {
        throw BadOption("the maximal size is smaller than the spacing of the lattice, which is the size of "
                        "tets at the surface");
    }
    return frame;
}

OptimizeOptions optimizeGoals(const Options& options, const Report& report) {
    return {*options.optimize, options.sweeps, kOffSurface * report.voxelSize / report.spacing};
}

} // namespace vdbtet
