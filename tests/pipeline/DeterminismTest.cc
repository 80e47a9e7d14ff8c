// The mesh is the same, bit for bit, for any number of threads and from run to run.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Meshed meshWithThreads(int threads, const openvdb::GridBase& grid, const Options& options) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    tbb::task_arena arena(threads);
    Meshed result;
    arena.execute([&] { result = meshOf(grid, options); });
    return result;
}

void requireSameReport(const Report& a, const Report& b) {
    CHECK(a.points == b.points);
    CHECK(a.tets == b.tets);
    CHECK(a.tetsOfLevel == b.tetsOfLevel);
    CHECK(a.boundaryTriangles == b.boundaryTriangles);
    CHECK(a.ambiguous == b.ambiguous);
    CHECK(a.conflicts == b.conflicts);
    CHECK(a.activeFlips == b.activeFlips);
    CHECK(a.extraFlips == b.extraFlips);
    CHECK(a.lastResortFlips == b.lastResortFlips);
    CHECK(a.qualityFlips == b.qualityFlips);
    CHECK(a.flagged == b.flagged);
    CHECK(a.guardRounds == b.guardRounds);
    CHECK(a.surfaceTiles == b.surfaceTiles);
    CHECK(a.cutEdges == b.cutEdges);
    CHECK(a.tieBroken == b.tieBroken);
    CHECK(a.boundary.found == b.boundary.found);
    CHECK(a.boundary.filled == b.boundary.filled);
    CHECK(a.boundary.peeled == b.boundary.peeled);
    CHECK(a.boundary.split == b.boundary.split);
    CHECK(a.verticesMoved == b.verticesMoved);
    CHECK(a.sweeps == b.sweeps);
    CHECK(a.anglesBefore.min == b.anglesBefore.min);
    CHECK(a.anglesBefore.max == b.anglesBefore.max);
    CHECK(a.angles.min == b.angles.min);
    CHECK(a.angles.max == b.angles.max);
    CHECK(a.angles.histogram == b.angles.histogram);
    CHECK(a.bounds == b.bounds);
    CHECK(a.places.ambiguous == b.places.ambiguous);
    CHECK(a.places.conflicts == b.places.conflicts);
    CHECK(a.places.pinched == b.places.pinched);
}

void requireDeterministic(const openvdb::GridBase& grid, const Options& options) {
    const Meshed alone = meshWithThreads(1, grid, options);
    for (const int threads : {1, 2, 4}) {
        const Meshed other = meshWithThreads(threads, grid, options);
        CAPTURE(threads);
        requireIdentical(alone.mesh, other.mesh);
        requireSameReport(alone.report, other.report);
    }
}

} // namespace

TEST_CASE("any number of threads gives the same bytes: a shape of many tiles") {
    requireDeterministic(*levelSet(torus({0.3, -0.2, 0.1}, 25, 11)), atVoxels(0.9));
    requireDeterministic(*levelSet(box({-30.2, -20.1, -25.7}, {31.1, 24.6, 28.3})), atVoxels(1.0));
}

TEST_CASE("any number of threads gives the same bytes: noise") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        requireDeterministic(*levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 22, 1.5)), atVoxels(0.9));
}

TEST_CASE("any number of threads gives the same bytes: ties and cycles") {
    requireDeterministic(*randomSigns(40, 1), atVoxels(1.0));
    requireDeterministic(*randomCuts(24, 2, 0.7), atVoxels(2.0));
    // Every cut point is in the middle of its edge.
    requireDeterministic(*levelSet(box({-10.5, -10.5, -10.5}, {10.5, 10.5, 10.5})), atVoxels(1.0));
}

TEST_CASE("any number of threads gives the same bytes: graded") {
    Options options = atVoxels(0.8);
    options.grade = true;
    requireDeterministic(*levelSet(torus({0.3, -0.2, 0.1}, 40, 18)), options);
    requireDeterministic(*levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 25, 6)), options);
    options.maxSize = 2.0;
    requireDeterministic(*levelSet(sphere({0.3, -0.2, 0.1}, 30)), options);
}

TEST_CASE("any number of threads gives the same bytes: optimised") {
    for (const bool grade : {false, true}) {
        Options options = atVoxels(0.8);
        options.optimize = 34;
        options.grade = grade;
        requireDeterministic(*levelSet(torus({0.3, -0.2, 0.1}, 25, 11)), options);
        requireDeterministic(*levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 22, 2)), options);
        requireDeterministic(*randomSigns(24, 1), options);
    }
}

TEST_CASE("any number of threads gives the same bytes: version 3") {
    requireDeterministic(*levelSet(torus({0.3, -0.2, 0.1}, 25, 11)), atVoxels(0.9, 3));
    for (const bool grade : {false, true}) {
        Options options = atVoxels(0.9, 3);
        options.grade = grade;
        requireDeterministic(*levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 22, 1.5)), options);
        options.optimize = 34;
        requireDeterministic(*randomSigns(24, 1), options);
    }
    requireDeterministic(*randomCuts(24, 2, 0.7), atVoxels(2.0, 3));
    requireDeterministic(*levelSet(box({-10.5, -10.5, -10.5}, {10.5, 10.5, 10.5})), atVoxels(1.0, 3));
}
