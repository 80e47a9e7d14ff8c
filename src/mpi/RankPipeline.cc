/// @file RankPipeline.cc
/// Each stage does what is the rank's own; what it needs of others is exchanged between two stages.
#include "mpi/RankPipeline.h"

#include "mpi/RankFlips.h"
#include "mpi/RankGrading.h"
#include "mpi/RankRepair.h"

#include "BeginRun.h"
#include "Limits.h"
#include "Stage.h"
#include "Tell.h"
#include "cuts/Arrows.h"
#include "destinations/Destinations.h"
#include "guard/Guard.h"
#include "optimize/Optimize.h"

#include <vdbtet/Errors.h>

#include <malloc.h>

#include <optional>
#include <utility>

namespace vdbtet::mpi {

namespace {

/// @brief Let go of the rank's part of the grid.
/// @details Voxels are in small blocks, which the C library keeps, while the arrays to come are too large for
/// them.
void dropField(std::shared_ptr<const Field>& field) {
    field.reset();
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

} // namespace

bool runPart(Comm& comm, std::shared_ptr<const Field> field, const Frame& frame, const Options& options,
             Skeleton skeleton, const std::vector<std::int64_t>& own, int margin, MeshSink& sink,
             Report& report, RankReport& rankReport) {
    Interrupt interrupt(nullptr); // ranks stop by signals
    const auto stage = [&](const char* name, auto&& work) { return runStage(name, interrupt, report, work); };
    std::vector<openvdb::Coord> tiles;
    for (const std::int64_t tile : own) tiles.push_back(skeleton.tiles[std::size_t(tile)]);
    report.surfaceTiles = std::int64_t(skeleton.tiles.size());
    const bool isThird = options.tiger == 3;
    const double tau = isThird ? options.tau.value_or(kDefaultTau) : 0.5;
    std::optional<Cuts> cuts = stage("cuts", [&] {
        std::optional<Cuts> found;
        comm.together([&] { found = findCuts(*field, tiles, tau, interrupt); });
        return found;
    });
    report.cutEdges = cuts->arrows.cutEdges;
    comm.sum(report.cutEdges);
    std::vector<TileSigns> signs = std::move(cuts->signs);

    const RankPart part = stage("layout", [&] {
        std::vector<TileEnds> ends;
        for (const TileSigns& tile : signs) ends.push_back(TileEnds::of(tile));
        return makePart(comm, skeleton, own, ends, options.grade);
    });
    std::vector<openvdb::Coord>().swap(skeleton.tiles); // the layout's spans have them
    const Layout& layout = part.layout;
    const Seams& beside = *part.beside;
    rankReport.surfaceTiles = layout.ownCount();
    rankReport.borrowedTiles = layout.borrowed;
    if (report.cutEdges == 0)
        throw NoSurface("the shape slips between the lattice points; use a finer spacing");
    requireFewTets(layout, options);
    signs.resize(layout.surfaceTiles.size());
    beside.exchange(signs);
    if (options.grade) part.far->exchange(signs);

    Labels labels = stage("labels", [&] { return labelVertices(layout, cuts->arrows, interrupt, beside); });
    Destinations destinations = stage("destinations", [&] {
        Destinations found;
        comm.together([&] {
            found = isThird ? findGradientDestinations(*field, layout, cuts->arrows, labels, {tau, nullptr},
                                                       nullptr, nullptr, interrupt)
                            : findDestinations(*field, layout, cuts->arrows, labels, interrupt);
        });
        found.exchange(beside);
        return found;
    });
    if (!isThird) cuts.reset();
    Vertices vertices{layout, signs, labels, destinations};
    std::optional<QualityFlips> quality;
    Flips flips = stage("flips", [&] {
        if (!isThird) return flipPart(comm, beside, vertices, options.tiger, interrupt);
        quality.emplace(vertices);
        quality->chooseAll(interrupt, beside);
        return Flips();
    });
    bool passed = false;
    if (isThird) {
        const Guarded guarded = stage("guard", [&] {
            return guardAngles(*field, tau, vertices, {cuts->arrows, labels, destinations, *quality},
                               interrupt, beside);
        });
        report.flagged = guarded.count;
        report.guardRounds = guarded.rounds;
        passed = guarded.tilesWithBad == 0;
        flips = quality->flips();
        sumFlips(comm, flips);
        quality.reset();
        cuts.reset();
    }
    if (!options.optimize) dropField(field);
    tellLabels(labels, flips, report);

    const Repair repair =
        stage("repair", [&] { return repairPart(comm, vertices, flips, options.boundary, interrupt); });
    if (repair.leavesSurface && margin == 0) return false;
    report.boundary = repair.counts;
    if (!repair.changes.tiles.empty()) vertices.changes = &repair.changes;

    Optimized optimized;
    if (options.optimize) {
        optimized = stage("optimize", [&] {
            return optimize(*field, vertices, flips, optimizeGoals(options, report), interrupt, beside);
        });
        comm.least(optimized.before.min);
        comm.most(optimized.before.max);
        vertices.moves = &optimized.moves;
        dropField(field);
    }
    const auto& moved = options.optimize ? optimized.moves.moved : labels.manifold;
    const auto outer = vertices.changes ? vertices.changes->withExposed(moved) : VertexMasks();
    const Grading grading = stage("grading", [&] {
        const int top = options.grade ? coarsestLevel(layout, mostCells(options, frame)) : 0;
        return gradePart(comm, part, signs, vertices.changes ? outer : moved, top, interrupt);
    });
    OtherRanks others(comm, layout, grading);
    Numbering numbering =
        stage("numbering", [&] { return numberMesh(vertices, flips, grading, frame, interrupt, &others); });
    others.addUsed(part, numbering);
    tellNumbers(numbering, options, passed, report);
    const std::vector<TileRange> ranges = others.ranges(part, skeleton, numbering);
    for (const TileRange& range : ranges) {
        const auto before = [&](const Place& at) {
            return numbering.firstTet[std::size_t(at.span)] + numbering.runTets * at.offset;
        };
        rankReport.tets += before(range.end) - before(range.begin);
    }

    if (comm.rank() != 0) numbering.kinds = {}; // these are all ranks', and summed once

    const bool wantsChunks = stage("begin", [&] {
        bool wants = false;
        comm.together([&] { wants = sink.begin(totalsOf(numbering, frame)); });
        return wants;
    });
    AngleSum angles = stage(wantsChunks ? "emit" : "measure", [&] {
        AngleSum sum;
        comm.together([&] {
            sum = wantsChunks ? emitMesh(vertices, flips, grading, numbering, frame, ranges, sink, interrupt)
                              : measureMesh(vertices, flips, grading, numbering, frame, interrupt, &others);
        });
        return sum;
    });
    struct {
        void least(double& value) { all.least(value); }
        void most(double& value) { all.most(value); }
        void sum(std::int64_t* values, std::size_t count) { all.sum(values, count); }
        Comm& all;
    } reduction{comm};
    angles.reduce(reduction);
    tellAngles(angles, options.optimize ? &optimized : nullptr, report);
    stage("end", [&] {
        comm.together([&] { sink.end(); });
        return 0;
    });
    return true;
}

} // namespace vdbtet::mpi
