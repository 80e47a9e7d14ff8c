// The boundary is a surface even where the lattice does not resolve the shape, and nothing else changes.
#include "support/Boundary.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Options with(Options options, Boundary boundary) {
    options.boundary = boundary;
    return options;
}

/// The corners of all tets, in ascending order.
std::vector<std::array<std::array<double, 3>, 4>> cornersOfTets(const TetMesh& mesh) {
    std::vector<std::array<std::array<double, 3>, 4>> all;
    for (const Tet& tet : mesh.tets) {
        std::array<std::array<double, 3>, 4> corners;
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3d& p = mesh.points[std::size_t(tet[i])];
            corners[i] = {p.x(), p.y(), p.z()};
        }
        std::sort(corners.begin(), corners.end());
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Hold all ways to treat the boundary to what they promise.
/// @return what was mended
BoundaryCounts requireMended(const openvdb::GridBase& grid, const Options& options) {
    CAPTURE(options.voxels, options.tiger, options.grade);
    const Meshed raw = meshOf(grid, with(options, Boundary::Raw)),
                 fill = meshOf(grid, with(options, Boundary::Fill)),
                 whole = meshOf(grid, with(options, Boundary::Manifold));
    // Each judged by the count of points that are no surface, 0 for the last.
    for (const Meshed* one : {&raw, &fill, &whole}) requireClean(one->mesh, one->report);
    const BoundaryCounts &none = raw.report.boundary, &some = fill.report.boundary,
                         all = whole.report.boundary;
    CHECK(none.left == none.found);
    CHECK(none.filled + none.peeled + none.split == 0);
    CHECK(some.found == none.found);
    CHECK(some.peeled + some.split == 0);
    CHECK(some.left <= some.found);
    CHECK(all.found == none.found);
    CHECK(all.filled <= some.filled); // what is filled may be taken out later
    CHECK(all.left == 0);
    if (none.found == 0) {
        requireIdentical(raw.mesh, whole.mesh);
        requireIdentical(raw.mesh, fill.mesh);
        CHECK(all.filled + all.peeled + all.split == 0);
        return all;
    }
    CHECK(raw.report.ambiguous - whole.report.ambiguous == all.filled);
    if (options.grade) return all; // points of the inside that are on the boundary have no coarse tets
    const auto before = cornersOfTets(raw.mesh), now = cornersOfTets(whole.mesh);
    std::vector<std::array<std::array<double, 3>, 4>> more, less;
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(more));
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(less));
    CHECK(std::int64_t(more.size()) == all.filled);
    CHECK(std::int64_t(less.size()) == all.peeled);
    return all;
}

} // namespace

TEST_CASE("a boundary that is a surface stays as it is, bit for bit") {
    for (const double voxels : {0.7, 1.0, 2.0}) {
        const BoundaryCounts counts =
            requireMended(*levelSet(torus({0.3, 0.2, 0.1}, 20, 8)), atVoxels(voxels));
        CHECK(counts.found == 0);
    }
}

TEST_CASE("the boundary is a surface whatever the shape: thin walls") {
    std::int64_t filled = 0, split = 0;
    for (const double thickness : {1.0, 1.5, 2.0, 3.0}) {
        const auto grid = levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, thickness));
        for (const double voxels : {0.8, 1.0, 1.37}) {
            const BoundaryCounts counts = requireMended(*grid, atVoxels(voxels));
            filled += counts.filled;
            split += counts.split;
        }
    }
    CHECK(filled > 0);
    CHECK(split > 0);
}

TEST_CASE("the boundary is a surface whatever the shape: noise") {
    std::int64_t peeled = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const auto noise = levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 14, 1.5));
        const auto cuts = randomCuts(10, seed, 0.7), signs = randomSigns(14, seed);
        for (const bool grade : {false, true}) {
            for (const int tiger : {1, 2, 3}) {
                const auto options = [&](double voxels) {
                    Options result = atVoxels(voxels, tiger);
                    result.grade = grade;
                    return result;
                };
                for (const double voxels : {0.6, 1.0, 1.7}) {
                    requireMended(*noise, options(voxels));
                    peeled += requireMended(*signs, options(voxels)).peeled;
                }
                peeled += requireMended(*cuts, options(2.0)).peeled;
            }
        }
    }
    CHECK(peeled > 0);
}

TEST_CASE("a solid with a rough skin is mended graded as it is uniform") {
    // Deep enough that the inside has coarse tets next to the mended places.
    const auto grid = levelSet(sphere({0.1, 0.2, 0.3}, 20));
    Random random(7);
    for (auto value = grid->beginValueOn(); value; ++value) {
        if (std::abs(*value) < 2.5f) value.setValue(float(random.uniform(-2.5, 2.5)));
    }
    std::int64_t peeled = 0, split = 0;
    for (const double voxels : {1.0, 1.5}) {
        Options options = atVoxels(voxels);
        const BoundaryCounts uniform = requireMended(*grid, options);
        options.grade = true;
        const BoundaryCounts graded = requireMended(*grid, options);
        peeled += uniform.peeled;
        split += uniform.split;
        CHECK(graded.filled == uniform.filled);
        CHECK(graded.peeled == uniform.peeled);
        CHECK(graded.split == uniform.split);
    }
    CHECK(peeled > 0);
    CHECK(split > 0);
}

TEST_CASE("what is mended can be optimised, too") {
    for (const auto& grid : {levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, 2.0)), randomSigns(20, 4)}) {
        Options options = atVoxels(1.0);
        const Meshed plain = meshOf(*grid, options);
        options.optimize = 30.0;
        for (const bool grade : {false, true}) {
            options.grade = grade;
            const Meshed better = meshOf(*grid, options);
            requireClean(better.mesh, better.report);
            CHECK(better.report.boundary.filled == plain.report.boundary.filled);
            CHECK(better.report.boundary.split == plain.report.boundary.split);
            CHECK(better.report.angles.min > plain.report.angles.min);
            CHECK(better.report.boundaryTriangles == plain.report.boundaryTriangles);
        }
    }
}

TEST_CASE("boundary triangles have the points of their tets, where points are doubled, too") {
    struct BoundarySink final : MeshSink {
        bool begin(const MeshTotals& totals) override { return mesh.begin(totals); }
        void chunk(const MeshChunk& chunk) override {
            triangles.insert(triangles.end(), chunk.triangles.begin(), chunk.triangles.end());
            points.insert(points.end(), chunk.surfacePoints.begin(), chunk.surfacePoints.end());
            mesh.chunk(chunk);
        }
        void end() override { mesh.end(); }
        MeshWants wants() const override { return {true, false, false}; }

        TetMesh mesh;
        std::vector<Triangle> triangles;
        std::vector<std::int64_t> points;
    };
    const auto sorted = [](Triangle triangle) {
        std::sort(triangle.begin(), triangle.end());
        return triangle;
    };
    for (const auto& grid : {levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 14, 1.5)), randomSigns(24, 7)}) {
        BoundarySink sink;
        const Report report = volumeToTets(*grid, sink);
        REQUIRE(report.boundary.split > 0);
        std::map<Triangle, int> tetsOf;
        for (const Tet& tet : sink.mesh.tets) {
            for (std::size_t i = 0; i < 4; ++i)
                ++tetsOf[sorted({tet[i], tet[(i + 1) % 4], tet[(i + 2) % 4]})];
        }
        std::set<Triangle> expected, found;
        for (const auto& [triangle, tets] : tetsOf) {
            if (tets == 1) expected.insert(triangle);
        }
        std::set<std::int64_t> corners;
        for (const Triangle& triangle : sink.triangles) {
            CHECK(found.insert(sorted(triangle)).second);
            corners.insert(triangle.begin(), triangle.end());
        }
        CHECK((found == expected));
        CHECK(std::is_sorted(sink.points.begin(), sink.points.end()));
        CHECK(std::includes(sink.points.begin(), sink.points.end(), corners.begin(), corners.end()));
    }
}
