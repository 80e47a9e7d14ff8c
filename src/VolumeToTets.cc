/// @file VolumeToTets.cc
/// From a grid and options to a field, and messages that name the grid.
#include <vdbtet/VolumeToTets.h>

#include <vdbtet/Errors.h>

#include "ChooseLevel.h"
#include "Pipeline.h"
#include "Stage.h"
#include "field/FiniteGrid.h"
#include "field/GridField.h"

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

template <typename GridT>
Report meshGrid(const GridT& grid, MeshSink& sink, const Options& options,
                openvdb::util::NullInterrupter* interrupter) {
    checkOptions(options);
    Report report;
    report.gridName = grid.getName();
    report.tiger = options.tiger;
    report.voxelSize = shortestVoxelEdge(grid.transform());
    report.spacing = options.spacing.value_or(options.voxels * report.voxelSize);
    const Frame frame = makeFrame(grid.transform(), report.spacing);
    if (options.maxSize && !(*options.maxSize >= report.spacing)) {
        throw BadOption("the maximal size is smaller than the spacing of the lattice, which is the size of "
                        "tets at the surface");
    }
    const Level level = chooseLevel(grid, double(grid.background()), options, report);
    Interrupt interrupt(interrupter);
    const FiniteGrid<GridT> finite = runStage(
        "scan", interrupt, report, [&] { return FiniteGrid<GridT>(grid, level, options.nan, interrupt); });
    if (report.cancelled) return report;
    requireInside(finite.values(), level);
    report.badValues = finite.replaced();
    report.gridMemory = finite.memory();
    const GridField<GridT> field(finite.grid(), frame, level);
    runPipeline(field, frame, options, sink, interrupt, report);
    return report;
}

} // namespace

/// Run, naming the grid in whatever this library has to say against it.
template <typename GridT>
Report volumeToTets(const GridT& grid, MeshSink& sink, const Options& options,
                    openvdb::util::NullInterrupter* interrupter) {
    try {
        return meshGrid(grid, sink, options, interrupter);
    } catch (const FileError&) {
        throw; // a sink's, and about its file
    } catch (Error& error) {
        error.prefix(quoted(grid));
        throw;
    }
}

template Report volumeToTets(const openvdb::FloatGrid&, MeshSink&, const Options&,
                             openvdb::util::NullInterrupter*);
template Report volumeToTets(const openvdb::DoubleGrid&, MeshSink&, const Options&,
                             openvdb::util::NullInterrupter*);

Report volumeToTets(const openvdb::GridBase& grid, MeshSink& sink, const Options& options,
                    openvdb::util::NullInterrupter* interrupter) {
    if (const auto* floats = dynamic_cast<const openvdb::FloatGrid*>(&grid)) {
        return volumeToTets(*floats, sink, options, interrupter);
    }
    if (const auto* doubles = dynamic_cast<const openvdb::DoubleGrid*>(&grid)) {
        return volumeToTets(*doubles, sink, options, interrupter);
    }
    throw UnsupportedGrid(quoted(grid) + ": a grid of type " + grid.type() +
                          " cannot be meshed; only float and double grids can");
}

} // namespace vdbtet
