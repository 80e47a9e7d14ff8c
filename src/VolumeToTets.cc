/// @file VolumeToTets.cc
/// From a grid and options to a field, and messages that name the grid.
#include <vdbtet/VolumeToTets.h>

#include <vdbtet/Errors.h>

#include "BeginRun.h"
#include "ChooseLevel.h"
#include "Pipeline.h"
#include "Stage.h"
#include "field/FiniteGrid.h"
#include "field/GridField.h"

namespace vdbtet {

namespace {

template <typename GridT>
Report meshGrid(const GridT& grid, MeshSink& sink, const Options& options,
                openvdb::util::NullInterrupter* interrupter) {
    Report report;
    const Frame frame = beginRun(grid, options, report);
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
