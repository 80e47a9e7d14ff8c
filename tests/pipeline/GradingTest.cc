// A graded mesh is a valid mesh with the surface of the uniform one, and grows as that surface.
#include "support/Boundary.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include "bcc/Frame.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Options graded(Options options) {
    options.grade = true;
    return options;
}

double longestEdge(const TetMesh& mesh) {
    double longest = 0;
    for (const Tet& tet : mesh.tets) {
        for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                const Vec3d edge = mesh.points[std::size_t(tet[a])] - mesh.points[std::size_t(tet[b])];
                longest = std::max(longest, edge.length());
            }
        }
    }
    return longest;
}

/// The extreme angles of the tets all of whose vertices are in their places in the lattice.
AngleBound anglesInside(const TetMesh& mesh, const Frame& frame) {
    const openvdb::Mat3d fromWorld = frame.toWorld.inverse();
    std::vector<bool> moved;
    moved.reserve(mesh.points.size());
    for (const Vec3d& point : mesh.points) {
        const Vec3d twice = 2.0 * (fromWorld * (point - frame.origin));
        double off = 0;
        for (int axis = 0; axis < 3; ++axis)
            off = std::max(off, std::abs(twice[axis] - std::round(twice[axis])));
        moved.push_back(off > 1e-6);
    }
    AngleBound bound{180, 0};
    for (const Tet& tet : mesh.tets) {
        std::array<Vec3d, 4> p;
        bool anyMoved = false;
        for (std::size_t i = 0; i < 4; ++i) {
            p[i] = mesh.points[std::size_t(tet[i])];
            anyMoved = anyMoved || moved[std::size_t(tet[i])];
        }
        if (anyMoved) continue;
        for (const double angle : angleOfEdges(p[0], p[1], p[2], p[3])) {
            bound.lo = std::min(bound.lo, angle);
            bound.hi = std::max(bound.hi, angle);
        }
    }
    return bound;
}

struct Pair {
    Meshed uniform, graded;
};

/// Mesh both ways, and hold the graded mesh to what it promises.
Pair requireGraded(const openvdb::GridBase& grid, const Options& options) {
    const Pair pair{meshOf(grid, options), meshOf(grid, graded(options))};
    const Report& report = pair.graded.report;
    requireClean(pair.graded.mesh, report);
    REQUIRE(boundaryOf(pair.graded.mesh) == boundaryOf(pair.uniform.mesh));
    CHECK(report.boundaryTriangles == pair.uniform.report.boundaryTriangles);
    CHECK(report.ambiguous == pair.uniform.report.ambiguous);
    CHECK(report.bounds == pair.uniform.report.bounds);
    CHECK(report.tets <= pair.uniform.report.tets);
    std::int64_t tets = 0;
    for (const std::int64_t ofLevel : report.tetsOfLevel) tets += ofLevel;
    CHECK(tets == report.tets);
    const AngleBound inside = anglesInside(pair.graded.mesh, makeFrame(grid.transform(), report.spacing));
    CHECK(inside.lo >= 45 - 1e-4);
    CHECK(inside.hi <= 120 + 1e-4);
    // Edges at the surface, which are flipped and moved, may be as long as those of the second level.
    const double longest = std::ldexp(report.spacing, int(report.tetsOfLevel.size()) - 1);
    CHECK(longestEdge(pair.graded.mesh) <= std::max(longest * (1 + 1e-9), 2.5 * report.spacing));
    return pair;
}

} // namespace

TEST_CASE("a graded mesh has the uniform mesh's surface: solids", "[grading]") {
    requireGraded(*levelSet(sphere({0.1, -0.2, 0.3}, 30)), atVoxels(1));
    requireGraded(*levelSet(sphere({100.4, -37.2, 11.1}, 24)), atVoxels(0.7));
    requireGraded(*levelSet(torus({0.3, 0.2, 0.1}, 25, 12)), atVoxels(1.3));
    requireGraded(*levelSet(box({-33.2, -20.1, -25.7}, {31.1, 24.6, 28.3})), atVoxels(1));
    requireGraded(*levelSet(gyroidBall({0.1, 0.2, 0.3}, 24, 12, 3)), atVoxels(1));
}

TEST_CASE("a graded mesh has the uniform mesh's surface: noise and random signs", "[grading]") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        requireGraded(*levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 24, 3.0 * double(seed))), atVoxels(1));
        requireGraded(*randomSigns(20, seed), atVoxels(1));
        requireGraded(*randomCuts(16, seed, 0.9), atVoxels(2));
    }
}

TEST_CASE("a graded mesh has the uniform mesh's surface: wherever it lies", "[grading]") {
    // Of each power of two the corners of octants are near the surface in another way.
    for (int at = 0; at < 8; ++at) {
        const Vec3d centre(7.3 * at, -11.1 * at, 3.7 * at * at);
        requireGraded(*levelSet(sphere(centre, 13 + at)), atVoxels(1));
    }
    requireGraded(*levelSet(twoBalls({0, 0, 0}, 11, 300)), atVoxels(1));
    requireGraded(*levelSet(sphere({0, 0, 0}, 20), shearedTransform(1)), atVoxels(1));
    requireGraded(*levelSet(sphere({0, 0, 0}, 20), mirroredTransform(1)), atVoxels(1));
    requireGraded(*levelSet(sphere({0, 0, 0}, 20), rotatedTransform(0.5)), atVoxels(1.5));
}

TEST_CASE("a graded mesh has the uniform mesh's surface: tiles", "[grading]") {
    requireGraded(*constantTiles(8, {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {24, 24, 24}}, true), atVoxels(1));
    requireGraded(*constantTiles(128, {{0, 0, 0}}, true), atVoxels(2));
}

TEST_CASE("no edge of a graded mesh is longer than its maximal size", "[grading]") {
    const auto grid = levelSet(sphere({0.1, 0.2, 0.3}, 20), 0.5);
    std::int64_t before = meshOf(*grid).report.tets;
    for (int level = 1; level <= 6; ++level) {
        Options options = graded(atVoxels(1));
        options.maxSize = 0.5 * std::ldexp(1.3, level);
        const Meshed meshed = meshOf(*grid, options);
        CAPTURE(level);
        requireClean(meshed.mesh, meshed.report);
        CHECK(longestEdge(meshed.mesh) <= *options.maxSize);
        CHECK(longestEdge(meshed.mesh) >= 0.5 * std::min(std::ldexp(1.0, level), 16.0));
        CHECK((level <= 4 ? meshed.report.tets < before : meshed.report.tets == before));
        before = meshed.report.tets;
    }
}

TEST_CASE("a maximal size that lets nothing grow gives the uniform mesh", "[grading]") {
    const auto grid = levelSet(torus({0.3, 0.2, 0.1}, 25, 12));
    Options options = graded(atVoxels(1));
    options.maxSize = 1.9;
    requireIdentical(meshOf(*grid, options).mesh, meshOf(*grid).mesh);
}

TEST_CASE("coarse octants fill large solids", "[grading]") {
    // 512 voxels an edge are 1.6 billion tets of the lattice.
    std::vector<openvdb::Coord> tiles;
    for (int n = 0; n < 64; ++n) tiles.emplace_back(128 * (n >> 4), 128 * (n >> 2 & 3), 128 * (n & 3));
    const auto grid = constantTiles(128, tiles, false);
    const Meshed meshed = meshOf(*grid, graded(atVoxels(8)));
    const MeshFigures figures = requireClean(meshed.mesh, meshed.report);
    CHECK(figures.volume ==
          Approx(std::pow(meshOf(*grid, atVoxels(8)).report.bounds.extents()[0], 3)).epsilon(0.01));
    CHECK(meshed.report.tetsOfLevel.size() == 6);

    // With a limit there are runs of tiles alike, in tiers above the first too.
    for (const double size : {17.0, 33.0, 65.0, 129.0}) {
        Options options = graded(atVoxels(8));
        options.maxSize = size;
        const Meshed limited = meshOf(*grid, options);
        CAPTURE(size);
        CHECK(requireClean(limited.mesh, limited.report).volume == Approx(figures.volume).epsilon(0.01));
        CHECK(longestEdge(limited.mesh) <= size);
    }
}

TEST_CASE("a graded ball has as many tets as its surface asks for", "[grading]") {
    // Counted by an independent trial of the construction.
    const std::int64_t at64 = meshOf(*levelSet(sphere({0, 0, 0}, 32)), graded({})).report.tets;
    const std::int64_t at128 = meshOf(*levelSet(sphere({0, 0, 0}, 64)), graded({})).report.tets;
    CHECK(double(at64) == Approx(270841).epsilon(0.02));
    CHECK(double(at128) == Approx(1129538).epsilon(0.02));
}

TEST_CASE("maximal sizes that cannot be are refused", "[grading]") {
    const auto grid = levelSet(sphere({0, 0, 0}, 10));
    Options options;
    options.maxSize = 4.0;
    CHECK_THROWS_AS(meshOf(*grid, options), BadOption); // without grading
    for (const double size : {0.99, 0.0, -1.0, std::nan("")}) {
        options = graded({});
        options.maxSize = size;
        CHECK_THROWS_AS(meshOf(*grid, options), BadOption);
    }
}
