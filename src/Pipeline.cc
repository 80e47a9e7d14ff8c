/// @file Pipeline.cc
/// The stages in order (paper, Algorithm 1).
#include "Pipeline.h"

#include "Limits.h"
#include "Stage.h"
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

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

/// The largest distance between neighbouring numbers of @a digits mantissa bits up to @a magnitude, as a
/// fraction of @a spacing.
double roundingStep(double magnitude, int digits, double spacing) {
    return std::ldexp(1.0, std::ilogb(magnitude) + 1 - digits) / spacing;
}

/// @param places  in units of the lattice
std::vector<openvdb::Vec3d> inWorld(const Frame& frame, std::vector<openvdb::Vec3d> places) {
    for (openvdb::Vec3d& place : places) place = frame.world(place);
    return places;
}

MeshTotals totalsOf(const Numbering& numbering, const Frame& frame) {
    // A dihedral angle turns by at most about 35 times the relative error of its vertices: two faces, each
    // tilted by the errors of its three vertices over heights that the angle bounds keep above c / 6.
    constexpr double kRadiansPerError = 35.0;
    constexpr double kNegligible = 0.01 / 57.29577951308232; // 0.01 degrees
    MeshTotals totals;
    totals.points = numbering.points();
    totals.tets = numbering.tets();
    totals.triangles = numbering.triangles();
    totals.bounds = numbering.bounds;
    double magnitude = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        magnitude = std::max(
            {magnitude, std::abs(numbering.bounds.min()[axis]), std::abs(numbering.bounds.max()[axis])});
    }
    const auto turn = [&](int digits) {
        return kRadiansPerError * 0.5 * roundingStep(magnitude, digits, frame.spacing);
    };
    constexpr double kMaxFloat = 1e38, kMinFloat = 1e-30;
    totals.float32Suffices = turn(24) <= kNegligible && magnitude < kMaxFloat && frame.spacing > kMinFloat;
    if (!(turn(53) <= kNegligible)) {
        throw TooLarge(
            "the grid lies so far from the world's origin that double precision cannot resolve its lattice; "
            "move it nearer, or use a coarser spacing");
    }
    return totals;
}

/// How far points may be off the surface after optimisation, in voxels: half of what is promised.
constexpr double kOffSurface = 0.5e-3;

/// The level of the coarsest octants, 2^level cells an edge.
int topLevel(const Options& options, double spacing, const Layout& layout) {
    if (!options.grade) return 0;
    const int fitting = coarsestLevel(layout);
    if (!options.maxSize) return fitting;
    return std::min(fitting, int(std::floor(std::log2(*options.maxSize / spacing))));
}

/// @return the sharpest bounds that are proven for all tets of a run (docs/angles.md).
/// @param passed  whether the guard of version 3 has left no tet beyond its limits
AngleRange provenAngles(int tiger, const Flips& flips, bool passed, const BoundaryCounts& boundary) {
    constexpr AngleRange kResolved{11.47, 157.59}; // theorem 2, and what repair lets pass
    if (tiger == 3 && passed) return boundary.filled > 0 ? kResolved : AngleRange{kGuardMin, kGuardMax};
    if (tiger == 2 && flips.conflicts == 0) return kResolved;
    if (tiger == 2 && flips.conflicts == flips.lastResort) return {11.46, kResolved.max}; // theorem 3
    return {8.54, 164.18};
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
    std::optional<Cuts> cuts =
        stage("cuts", [&] { return std::make_optional(findCuts(field, tiles, tau, interrupt)); });
    if (report.cancelled) return true;
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
    report.backLabelled = labels.backLabelled;
    report.tieBroken = labels.tieBroken;
    report.worklistSeconds = labels.worklistSeconds;
    report.activeFlips = flips.active;
    report.qualityFlips = flips.quality;
    report.extraFlips = flips.extra;
    report.lastResortFlips = flips.lastResort;
    report.conflicts = flips.conflicts;
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
            const OptimizeOptions goals{*options.optimize, options.sweeps,
                                        kOffSurface * report.voxelSize / report.spacing};
            return optimize(field, vertices, flips, goals, interrupt);
        });
        if (report.cancelled) return true;
        report.verticesMoved = optimized.verticesMoved;
        report.sweeps = optimized.sweeps;
        vertices.moves = &optimized.moves;
    }
    // Around vertices that have moved, or that repair has brought to the boundary, graded meshes are uniform.
    const auto& moved = options.optimize ? optimized.moves.moved : labels.manifold;
    const auto outer = vertices.changes ? vertices.changes->withExposed(moved) : VertexMasks();
    const VertexMasks& uniform = vertices.changes ? outer : moved;
    const int top = topLevel(options, frame.spacing, layout);
    const Grading grading =
        stage("grading", [&] { return gradeInterior(layout, signs, uniform, top, interrupt); });
    if (report.cancelled) return true;
    const Numbering numbering =
        stage("numbering", [&] { return numberMesh(vertices, flips, grading, frame, interrupt); });
    if (report.cancelled) return true;
    report.points = numbering.points();
    report.tets = numbering.tets();
    report.boundaryTriangles = numbering.triangles();
    report.tetsOfLevel = numbering.tetsOfLevel;
    while (report.tetsOfLevel.size() > 1 && report.tetsOfLevel.back() == 0) report.tetsOfLevel.pop_back();
    report.ambiguous = numbering.ambiguous;
    report.places.ambiguous = inWorld(frame, numbering.ambiguousPlaces);
    report.bounds = numbering.bounds;
    if (report.tets == 0) {
        throw NoSurface(
            "the shape is thinner than the lattice can hold, and nothing of it is left; use a finer spacing");
    }
    requireFewTets(report.tets, options);
    const AngleRange proven = provenAngles(options.tiger, flips, passed, repair.counts);
    report.angleMin = proven.min;
    report.angleMax = proven.max;

    const bool wantsChunks = stage("begin", [&] { return sink.begin(totalsOf(numbering, frame)); });
    if (report.cancelled) return true;
    AngleSum angles = stage(wantsChunks ? "emit" : "measure", [&] {
        return wantsChunks ? emitMesh(vertices, flips, grading, numbering, frame, sink, interrupt)
                           : measureMesh(vertices, flips, grading, numbering, frame, interrupt);
    });
    if (report.cancelled) return true;
    report.angles = angles.stats();
    report.percentiles = angles.percentiles();
    report.angleBins = angles.bins();
    report.anglesBefore = {report.angles.min, report.angles.max};
    if (options.optimize) {
        // What was not measured before are tets of the lattice.
        report.anglesBefore = {std::min(optimized.before.min, 60.0), std::max(optimized.before.max, 90.0)};
    }
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
