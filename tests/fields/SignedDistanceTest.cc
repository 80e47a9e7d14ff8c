// Distances to the surface, against those of shapes whose distances are known.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>
#include <vdbtet/SignedDistance.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Keeps the mesh and its first field.
struct FieldSink final : MeshSink {
    bool begin(const MeshTotals& totals) override {
        name = totals.pointFields.at(0).name;
        return mesh.begin(totals);
    }
    void chunk(const MeshChunk& chunk) override {
        values.insert(values.end(), chunk.pointFields[0].begin(), chunk.pointFields[0].end());
        mesh.chunk(chunk);
    }
    void end() override { mesh.end(); }

    std::string name;
    TetMesh mesh;
    std::vector<float> values;
};

/// @brief Check the distances at the points of a mesh, but those where linear functions cannot follow: at the
/// end of the band, and far from the surface, in the middle of the shape.
/// @details OpenVDB finds another polygon than the nearest here and there.
void check(const openvdb::GridBase& grid, const Shape& shape, double width, const Options& options = {}) {
    FieldSink sink;
    FieldSampler sampler(sink, {signedDistance(grid, options, width)});
    volumeToTets(grid, sampler, options);
    REQUIRE(sink.name == "distance");
    REQUIRE(sink.values.size() == sink.mesh.points.size());
    double greatest = 0, nearSurface = 0, sum = 0, deepest = 0;
    std::int64_t count = 0;
    for (const Vec3d& p : sink.mesh.points) deepest = std::min(deepest, shape.distance(p));
    for (std::size_t i = 0; i < sink.values.size(); ++i) {
        const double expected = shape.distance(sink.mesh.points[i]), value = sink.values[i];
        if (expected < -width - 1.5) CHECK(value == Approx(-width));
        if (expected < std::max(-width, deepest + 1.0) + 1.5) continue;
        const double error = std::abs(value - expected);
        greatest = std::max(greatest, error);
        if (expected > -0.1) nearSurface = std::max(nearSurface, error);
        sum += error;
        ++count;
    }
    CHECK(greatest < 1.0);
    CHECK(nearSurface < 0.2);
    if (count > 0) CHECK(sum / double(count) < 0.06);
}

} // namespace

TEST_CASE("distances are those to the surface, as deep as asked", "[fields]") {
    const Shape ball = sphere({0.3, -0.2, 0.1}, 12.0);
    for (const double width : {0.7, 3.0, 8.0, 1e9}) {
        CAPTURE(width);
        check(*levelSet(ball), ball, width);
    }
}

TEST_CASE("distances of a fog volume are those to where it is meshed", "[fields]") {
    const Shape ball = sphere({0.3, -0.2, 0.1}, 12.0), larger = sphere({0.3, -0.2, 0.1}, 12.8);
    const auto fog = fogVolume(ball, uniformTransform(1.0));
    check(*fog, ball, 6.0);
    Options options;
    options.isovalue = 0.3; // the ramp falls by 0.25 a voxel
    check(*fog, larger, 6.0, options);
}

TEST_CASE("distances are in world space whatever the voxels", "[fields]") {
    const Shape ball = sphere({0.3, -0.2, 0.1}, 12.0);
    for (const auto& transform :
         {uniformTransform(0.5, Vec3d(0.1, 0.2, 0.3)), rotatedTransform(0.8), mirroredTransform(0.8),
          shearedTransform(0.8), nonuniformTransform({1.0, 0.6, 0.8})}) {
        check(*levelSet(ball, transform), ball, 4.0);
    }
}

TEST_CASE("distances are as good far from the origin", "[fields]") {
    const Vec3d far(1e6, -2e6, 3e6);
    const Shape ball = sphere(far, 12.0);
    check(*levelSet(ball, uniformTransform(1.0, far)), ball, 6.0);
    const auto grid = levelSet(sphere({0, 0, 0}, 12.0), uniformTransform(1.0));
    const auto moved = openvdb::FloatGrid::create(grid->background());
    moved->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::Coord step(1 << 23, -(1 << 22), 1 << 21);
    for (auto it = grid->cbeginValueOn(); it; ++it) moved->tree().setValue(it.getCoord() + step, *it);
    openvdb::tools::signedFloodFill(moved->tree());
    check(*moved, sphere(step.asVec3d(), 12.0), 6.0);
}

TEST_CASE("distances to the wall of a cavity count, too", "[fields]") {
    const Shape outer = sphere({0.3, -0.2, 0.1}, 20.0), inner = sphere({0.3, -0.2, 0.1}, 9.0);
    Shape shell = outer;
    shell.distance = [=](const Vec3d& p) { return std::max(outer.distance(p), -inner.distance(p)); };
    check(*levelSet(shell), shell, 10.0);
}

TEST_CASE("a grid of doubles has distances", "[fields]") {
    const Shape ball = sphere({0.3, -0.2, 0.1}, 12.0);
    const auto floats = levelSet(ball);
    const auto doubles = openvdb::DoubleGrid::create(std::make_shared<openvdb::DoubleTree>(floats->tree()));
    doubles->setTransform(floats->transformPtr());
    doubles->setGridClass(openvdb::GRID_LEVEL_SET);
    check(*doubles, ball, 5.0);
}

TEST_CASE("distances of what has no surface are refused", "[fields]") {
    const auto ball = levelSet(sphere({0.3, -0.2, 0.1}, 12.0));
    CHECK_THROWS_AS(signedDistance(*ball, {}, 0.0), BadOption);
    CHECK_THROWS_AS(signedDistance(*ball, {}, std::nan("")), BadOption);
    CHECK_THROWS_AS(signedDistance(*openvdb::Int32Grid::create()), UnsupportedGrid);
    CHECK_THROWS_AS(signedDistance(*openvdb::FloatGrid::create(1.0f)), NoSurface);
    Options options;
    options.inside = Inside::Above;
    CHECK_THROWS_AS(signedDistance(*ball, options), UnboundedInside);
    const auto bad = ball->deepCopy();
    bad->tree().setValue(openvdb::Coord(0), std::numeric_limits<float>::quiet_NaN());
    CHECK_THROWS_AS(signedDistance(*bad), BadValue);
}

TEST_CASE("distances can be interrupted, and the run that needs them is cancelled", "[fields]") {
    struct Stop final : openvdb::util::NullInterrupter {
        bool wasInterrupted(int) override { return true; }
    };
    const auto ball = levelSet(sphere({0.3, -0.2, 0.1}, 12.0));
    Stop stop;
    FieldSink sink;
    FieldSampler sampler(sink, {signedDistance(*ball, {}, 4.0, &stop)});
    CHECK(volumeToTets(*ball, sampler, {}, &stop).cancelled);
}
