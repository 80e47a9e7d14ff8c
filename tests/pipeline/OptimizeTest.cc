// Optimised meshes: the same tets, better ones, on the same surface.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include "bcc/Frame.h"
#include "field/GridField.h"

#include <openvdb/tools/ChangeBackground.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Options optimized(Options options, double target = 30, int sweeps = 5) {
    options.optimize = target;
    options.sweeps = sweeps;
    return options;
}

/// A mesh and its boundary's points. A point of the surface is none where tets are all around it.
struct BoundaryPoints final : MeshSink {
    bool begin(const MeshTotals& totals) override { return mesh.begin(totals); }
    void chunk(const MeshChunk& chunk) override {
        mesh.chunk(chunk);
        for (const auto& triangle : chunk.triangles) points.insert(triangle.begin(), triangle.end());
    }
    void end() override { mesh.end(); }
    MeshWants wants() const override {
        MeshWants wants;
        wants.triangles = true;
        return wants;
    }

    TetMesh mesh;
    std::set<std::int64_t> points;
};

/// How far the boundary's points are off the zero set at most, in voxels, to first order.
double farthestOffSurface(const openvdb::FloatGrid& grid, const Options& options) {
    BoundaryPoints sink;
    const Report report = volumeToTets(grid, sink, options);
    const Frame frame = makeFrame(grid.transform(), report.spacing);
    const GridField<openvdb::FloatGrid> field(grid, frame,
                                              Level{report.isovalue, report.inside == Inside::Below});
    const auto probe = field.probe();
    const openvdb::Mat3d fromWorld = frame.toWorld.inverse();
    double farthest = 0;
    REQUIRE(sink.points.size() > 100);
    for (const std::int64_t id : sink.points) {
        const FieldPoint at = probe->at(fromWorld * (sink.mesh.points[std::size_t(id)] - frame.origin));
        if (std::abs(at.phi) < 1e-6) continue; // whatever the gradient
        farthest = std::max(farthest, std::abs(at.phi) / at.gradient.length());
    }
    return farthest * report.spacing / report.voxelSize;
}

/// The mesh is that without optimisation but for better angles.
void requireImproved(const openvdb::FloatGrid& grid, const Options& options, double volumeTolerance) {
    CAPTURE(options.voxels, options.tiger, *options.optimize, options.sweeps);
    Options plain = options;
    plain.optimize.reset();
    const Meshed before = meshOf(grid, plain), after = meshOf(grid, options);
    const MeshFigures was = examine(before.mesh), is = requireClean(after.mesh, after.report);
    if (!options.grade) CHECK(before.mesh.tets == after.mesh.tets);
    CHECK(before.report.boundaryTriangles == after.report.boundaryTriangles);
    CHECK(is.nonmanifoldEdges == was.nonmanifoldEdges);
    CHECK(is.nonmanifoldPoints == was.nonmanifoldPoints);
    CHECK(is.components == was.components);
    CHECK(is.euler == was.euler);
    CHECK(is.volume == Approx(was.volume).epsilon(volumeTolerance));
    // Nothing leaves the guard, and what is outside of it gets no worse.
    CHECK(is.minAngle >= std::min(was.minAngle, 25.0) - 1e-6);
    CHECK(is.maxAngle <= std::max(was.maxAngle, 140.0) + 1e-6);
    CHECK(after.report.anglesBefore.min == before.report.angles.min);
    CHECK(after.report.anglesBefore.max == before.report.angles.max);
    // Where repair takes tets out, points of the inside come to lie on the boundary, and stay where they are.
    CHECK(farthestOffSurface(grid, after.report.boundary.peeled > 0 ? raw(options) : options) < 1e-3);
}

double qualityOf(const AngleStats& angles) {
    const auto sine = [](double angle) { return std::sin(angle / 57.29577951308232); };
    return std::min(sine(std::min(angles.min, 90.0)), 0.66 * sine(std::max(angles.max, 90.0)));
}

} // namespace

TEST_CASE("optimised meshes of resolved shapes reach their target", "[property][optimize]") {
    const Shape shapes[] = {sphere({0.1, 0.2, 0.3}, 11.3), torus({0.4, -0.2, 0.1}, 12, 5),
                            gyroidBall({0, 0, 0}, 14, 14, 4)};
    for (const Shape& shape : shapes) {
        const auto grid = levelSet(shape);
        for (const double voxels : {0.7, 1.0, 1.37, 1.9}) {
            const Report three = meshOf(*grid, optimized(atVoxels(voxels), 30, 3)).report;
            CHECK(three.angles.min > 25);
            CHECK(three.angles.max < 140);
            CHECK(three.verticesMoved > 0);
            const Report five = meshOf(*grid, optimized(atVoxels(voxels))).report;
            CHECK(five.angles.min > 29);
            CHECK(five.angles.max < 132);
            requireImproved(*grid, optimized(atVoxels(voxels)), 5e-4);
            requireImproved(*grid, optimized(atVoxels(voxels), 35), 5e-4);
        }
    }
}

TEST_CASE("optimised meshes of any field are as valid as before", "[property][optimize]") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        for (const int tiger : {1, 2, 3}) {
            for (const double feature : {1.0, 2.0, 4.0}) {
                const auto grid = levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 10, feature));
                requireImproved(*grid, optimized(atVoxels(1.0, tiger)), 3e-3);
            }
            requireImproved(*randomSigns(14, seed), optimized(atVoxels(0.7, tiger)), 2e-2);
            requireImproved(*randomCuts(10, seed, 0.7), optimized(atVoxels(2.0, tiger), 35), 2e-2);
        }
    }
}

TEST_CASE("the inside of an optimised mesh can be graded", "[property][optimize]") {
    for (const double voxels : {0.5, 1.0}) {
        Options options = optimized(atVoxels(voxels), 33);
        options.grade = true;
        requireImproved(*levelSet(torus({0.4, -0.2, 0.1}, 22, 11)), options, 5e-4);
        requireImproved(*levelSet(noiseBall(2, {0.1, 0.2, 0.3}, 16, 5)), options, 5e-4);
    }
}

TEST_CASE("neither the kind of field nor its transform matters", "[property][optimize]") {
    const Shape shape = torus({0.4, -0.2, 0.1}, 9, 4);
    const auto level = meshOf(*levelSet(shape), optimized(atVoxels(1.0)));
    for (const auto& transform : {rotatedTransform(0.7), mirroredTransform(0.7), shearedTransform(0.7)}) {
        const auto grid = levelSet(shape, transform);
        requireImproved(*grid, optimized(atVoxels(1.0)), 5e-4);
        CHECK(meshOf(*grid, optimized(atVoxels(1.0))).report.angles.min > 29);
    }
    const auto fog = fogVolume(shape, uniformTransform(1.0));
    requireImproved(*fog, optimized(atVoxels(1.0)), 2e-3);
    // The slope of the field is a matter of its unit.
    const auto steep = levelSet(shape);
    for (auto it = steep->beginValueAll(); it; ++it) it.setValue(*it * 1024.0f);
    openvdb::tools::changeBackground(steep->tree(), steep->background() * 1024.0f);
    requireIdentical(meshOf(*steep, optimized(atVoxels(1.0))).mesh, level.mesh);
}

TEST_CASE("no sweep makes the worst tet worse", "[property][optimize]") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto grid = levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 14, 3));
        double last = qualityOf(meshOf(*grid).report.angles);
        int sweeps = 0;
        for (int most = 1; most <= 6; ++most) {
            const Report report = meshOf(*grid, optimized(atVoxels(1.0), 36, most)).report;
            CHECK(qualityOf(report.angles) >= last - 1e-12);
            last = qualityOf(report.angles);
            CHECK(report.sweeps <= most);
            CHECK(report.sweeps >= sweeps);
            sweeps = report.sweeps;
        }
    }
}

TEST_CASE("a target that is met already moves nothing", "[optimize]") {
    const auto grid = levelSet(sphere({0.1, 0.2, 0.3}, 11.3));
    const Meshed plain = meshOf(*grid), same = meshOf(*grid, optimized(atVoxels(1.0), 5));
    CHECK(same.report.verticesMoved == 0);
    CHECK(same.report.sweeps == 0);
    requireIdentical(plain.mesh, same.mesh);
}

TEST_CASE("thin walls come within 25 and 140 degrees in three sweeps", "[optimize]") {
    // About as thick as a cell: some tets have all four corners on the surface, and these have far to go.
    Options options = atVoxels(4.0);
    options.optimize = 30.0;
    options.sweeps = 3;
    const Meshed wall = meshOf(*levelSet(gyroidBall({0.1, 0.2, 0.3}, 45, 45, 4.5)), options);
    CHECK(wall.report.angles.min > 25.0);
    CHECK(wall.report.angles.max < 140.0);
}
