/// @file PlacesTest.cc
/// The report's places are where it says they are, and no more of them are kept than may be.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Meshed meshWith(const openvdb::GridBase& grid, Boundary boundary, double voxels = 1.0) {
    Options options = atVoxels(voxels);
    options.boundary = boundary;
    return meshOf(grid, options);
}

std::vector<Vec3d> centroids(const TetMesh& mesh) {
    std::vector<Vec3d> all;
    for (const Tet& tet : mesh.tets) {
        Vec3d sum(0.0);
        for (const std::int64_t corner : tet) sum += mesh.points[std::size_t(corner)];
        all.push_back(0.25 * sum);
    }
    return all;
}

bool has(const std::vector<Vec3d>& all, const Vec3d& place) {
    return std::any_of(all.begin(), all.end(), [&](const Vec3d& one) { return one.eq(place, 1e-9); });
}

/// Those of @a all that are not among @a others.
std::vector<Vec3d> without(const std::vector<Vec3d>& all, const std::vector<Vec3d>& others) {
    std::vector<Vec3d> rest;
    for (const Vec3d& place : all) {
        if (!has(others, place)) rest.push_back(place);
    }
    return rest;
}

} // namespace

TEST_CASE("places of ambiguous tets are the centroids of those that repair can fill in") {
    const auto grid = levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, 1.5));
    const Meshed raw = meshWith(*grid, Boundary::Raw), fill = meshWith(*grid, Boundary::Fill);
    REQUIRE(fill.report.boundary.filled > 0);
    REQUIRE(raw.report.ambiguous < std::int64_t(Places::kMost));
    CHECK(std::int64_t(raw.report.places.ambiguous.size()) == raw.report.ambiguous);
    CHECK(std::int64_t(fill.report.places.ambiguous.size()) == fill.report.ambiguous);
    const auto dropped = raw.report.places.ambiguous;
    const auto filled = without(dropped, fill.report.places.ambiguous);
    CHECK(std::int64_t(filled.size()) == fill.report.boundary.filled);
    const auto before = centroids(raw.mesh), now = centroids(fill.mesh);
    for (const Vec3d& place : dropped) CHECK_FALSE(has(before, place));
    for (const Vec3d& place : filled) CHECK(has(now, place));
}

TEST_CASE("places of ambiguous tets are the same where the inside is graded") {
    const auto grid = levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, 1.5));
    Options options;
    options.grade = true;
    const Meshed uniform = meshOf(*grid), graded = meshOf(*grid, options);
    REQUIRE(!uniform.report.places.ambiguous.empty());
    CHECK(graded.report.places.ambiguous == uniform.report.places.ambiguous);
}

TEST_CASE("places where the boundary was no surface are points of the mesh") {
    const auto grid = levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, 1.5));
    const Meshed raw = meshWith(*grid, Boundary::Raw);
    const auto& places = raw.report.places.pinched;
    REQUIRE(raw.report.boundary.found > 0);
    CHECK(std::int64_t(places.size()) == raw.report.boundary.found);
    for (const Vec3d& place : places) CHECK(has(raw.mesh.points, place));
    CHECK(meshWith(*grid, Boundary::Manifold).report.places.pinched == places);
}

TEST_CASE("places of conflicts are the middles of long edges of the lattice") {
    std::int64_t conflicts = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Meshed found = meshWith(*randomCuts(12, seed), Boundary::Raw, 2.0);
        const auto& places = found.report.places.conflicts;
        CHECK(std::int64_t(places.size()) == found.report.conflicts);
        for (const Vec3d& place : places) {
            // Along the edge half a cell off L_A's vertices or L_B's, and not so across it.
            int off = 0;
            for (int axis = 0; axis < 3; ++axis)
                off += std::abs(std::remainder(place[axis] / found.report.spacing, 1.0)) > 0.25;
            CHECK((off == 1 || off == 2));
        }
        conflicts += found.report.conflicts;
    }
    CHECK(conflicts > 0);
}

TEST_CASE("a run keeps no more places than there may be") {
    const Report report = meshWith(*randomSigns(40, 1), Boundary::Manifold).report;
    REQUIRE(report.ambiguous > std::int64_t(Places::kMost));
    REQUIRE(report.boundary.found > std::int64_t(Places::kMost));
    CHECK(report.places.ambiguous.size() == Places::kMost);
    CHECK(report.places.pinched.size() == Places::kMost);
    const Report smooth = meshOf(*levelSet(sphere(Vec3d(0.0), 10))).report;
    CHECK(smooth.places.ambiguous.size() + smooth.places.conflicts.size() + smooth.places.pinched.size() ==
          0);
}
