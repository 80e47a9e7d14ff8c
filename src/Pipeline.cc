/// @file Pipeline.cc
/// The stages in order (paper, Algorithm 1).
#include "Pipeline.h"

#include "BeginRun.h"
#include "Limits.h"
#include "Stage.h"
#include "Tell.h"
#include "cuts/Arrows.h"
#include "destinations/Destinations.h"
#include "emit/Emit.h"
#include "flips/QualityFlips.h"
#include "grading/Grading.h"
#include "guard/Guard.h"
#include "labels/Labels.h"
#include "numbering/Numbering.h"
#include "optimize/Optimize.h"
#include "repair/Repair.h"
#include "tiles/Layout.h"

#include <vdbtet/Errors.h>

namespace vdbtet {

namespace {

/// @param places  in units of the lattice
std::vector<openvdb::Vec3d> inWorld(const Frame& frame, std::vector<openvdb::Vec3d> places) {
    for (openvdb::Vec3d& place : places) place = frame.world(place);
    return places;
}

/// All stages.
/// @param margin  of Field::surfaceTiles()
/// @return false where that is not enough
bool mesh(const Field& field, const Frame& frame, const Options& options, int margin, MeshSink& sink,
          Interrupt& interrupt, Report& report) {
    const auto stage = [&](const char* name, auto&& work) { return runStage(name, interrupt, report, work); };

    auto tiles =
        stage("tiles", [&] { return field.surfaceTiles(options.maxSurfaceTiles, margin, interrupt); });
    if (report.cancelled) return true;
    report.memory = report.gridMemory + estimateMemory(std::int64_t(tiles.size()), options);
    requireMemory(report.memory, options);
    const bool isThird = options.tiger == 3;
    const double tau = isThird ? options.tau.value_or(kDefaultTau) : 0.5;
    std::optional<Cuts> cuts = stage("cuts", [&] {
        return std::make_optional(findCuts(field, tiles, tau, interrupt, mostInsideTets(options)));
    });
    if (report.cancelled) return true;
    requireFewInsideTets(cuts->insideTets, options);
    const std::vector<TileSigns> signs = std::move(cuts->signs);
    const Layout layout = stage("layout", [&] { return makeLayout(std::move(tiles), signs, interrupt); });
    if (report.cancelled) return true;
    report.surfaceTiles = layout.surfaceCount();
    report.cutEdges = cuts->arrows.cutEdges;
    if (report.cutEdges == 0)
        throw NoSurface("the shape slips between the lattice points; use a finer spacing");
    requireFewTets(layout, options);
    Labels labels = stage("labels", [&] { return labelVertices(layout, cuts->arrows, interrupt); });
    if (report.cancelled) return true;
    Destinations destinations = stage("destinations", [&] {
        return isThird ? findGradientDestinations(field, layout, cuts->arrows, labels, {tau, nullptr},
                                                  nullptr, nullptr, interrupt)
                       : findDestinations(field, layout, cuts->arrows, labels, interrupt);
    });
    if (report.cancelled) return true;
    if (!isThird) cuts.reset(); // the largest product, and no one but the guard reads it again

    Vertices vertices{layout, signs, labels, destinations};
    std::optional<QualityFlips> quality;
    Flips flips = stage("flips", [&] {
        if (!isThird) return chooseFlips(vertices, options.tiger, interrupt);
        quality.emplace(vertices);
        quality->chooseAll(interrupt);
        return Flips();
    });
    if (report.cancelled) return true;
    bool passed = false;
    if (isThird) {
        const Guarded guarded = stage("guard", [&] {
            return guardAngles(field, tau, vertices, {cuts->arrows, labels, destinations, *quality},
                               interrupt);
        });
        report.flagged = guarded.count;
        report.guardRounds = guarded.rounds;
        passed = guarded.tilesWithBad == 0;
        flips = quality->flips();
        quality.reset();
        cuts.reset();
    }
    if (report.cancelled) return true;
    tellLabels(labels, flips, report);
    report.places.conflicts = inWorld(frame, flips.conflictPlaces);
    const Repair repair =
        stage("repair", [&] { return repairBoundary(vertices, flips, options.boundary, interrupt); });
    if (report.cancelled) return true;
    if (repair.leavesSurface && margin == 0) return false;
    report.boundary = repair.counts;
    report.places.pinched = inWorld(frame, repair.pinched);
    if (!repair.changes.tiles.empty()) vertices.changes = &repair.changes;
    Optimized optimized;
    if (options.optimize) {
        optimized = stage("optimize", [&] {
            return optimize(field, vertices, flips, optimizeGoals(options, report), interrupt);
        });
        if (report.cancelled) return true;
        vertices.moves = &optimized.moves;
    }
    // Around vertices that have moved, or that repair has brought to the boundary, graded meshes are uniform.
    const auto& moved = options.optimize ? optimized.moves.moved : labels.manifold;
    const auto outer = vertices.changes ? vertices.changes->withExposed(moved) : VertexMasks();
    const VertexMasks& uniform = vertices.changes ? outer : moved;
    const int top = options.grade ? coarsestLevel(layout, mostCells(options, frame)) : 0;
    const Grading grading =
        stage("grading", [&] { return gradeInterior(layout, signs, uniform, top, interrupt); });
    if (report.cancelled) return true;
    const Numbering numbering =
        stage("numbering", [&] { return numberMesh(vertices, flips, grading, frame, interrupt); });
    if (report.cancelled) return true;
    report.places.ambiguous = inWorld(frame, numbering.ambiguousPlaces);
    tellNumbers(numbering, options, passed, report);

    const bool wantsChunks = stage("begin", [&] { return sink.begin(totalsOf(numbering, frame)); });
    if (report.cancelled) return true;
    AngleSum angles = stage(wantsChunks ? "emit" : "measure", [&] {
        return wantsChunks
                   ? emitMesh(vertices, flips, grading, numbering, frame, allOf(numbering), sink, interrupt)
                   : measureMesh(vertices, flips, grading, numbering, frame, interrupt);
    });
    if (report.cancelled) return true;
    tellAngles(angles, options.optimize ? &optimized : nullptr, report);
    stage("end", [&] {
        sink.end();
        return 0;
    });
    report.cancelled = false; // too late
    return true;
}

} // namespace

void runPipeline(const Field& field, const Frame& frame, const Options& options, MeshSink& sink,
                 Interrupt& interrupt, Report& report) {
    const std::size_t before = report.stages.size();
    // Points that are moved on, those next to manifold ones, need a tile with a record, too.
    if (options.optimize) {
        mesh(field, frame, options, 1, sink, interrupt, report);
    } else if (!mesh(field, frame, options, 0, sink, interrupt, report)) {
        report.stages.resize(before);
        mesh(field, frame, options, 1, sink, interrupt, report);
    }
}

} // namespace vdbtet
