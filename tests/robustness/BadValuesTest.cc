// NaN and infinite values: refused with their number and place, or meshed as inside or outside.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>
#include <vdbtet/SignedDistance.h>

#include <cmath>
#include <limits>
#include <string>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;
using openvdb::FloatGrid;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

FloatGrid::Ptr ball() { return levelSet(sphere({0.3, -0.2, 0.1}, 8.2)); }

/// The ball with one value in fifty replaced, the same ones whatever by; and a tile inside.
FloatGrid::Ptr riddled(float by, float otherwise) {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 20.2));
    Random random(7);
    for (auto value = grid->beginValueOn(); value; ++value) {
        if (random.uniform(0, 1) < 0.02) value.setValue(random.next() & 1 ? by : otherwise);
    }
    grid->tree().addTile(1, Coord(0, 0, 0), by, false);
    return grid;
}

Options as(Nan nan, Options options = {}) {
    options.nan = nan;
    return options;
}

} // namespace

TEST_CASE("a grid with values that have no sign is refused with their number and the place of the first") {
    const auto grid = ball();
    grid->setTransform(uniformTransform(0.5, Vec3d(100, 0, 0)));
    grid->tree().setValue(Coord(6, 0, 1), kInfinity);
    grid->tree().setValue(Coord(6, 0, 0), kNan);
    const std::string message = refusal<BadValue>(*grid);
    CAPTURE(message);
    CHECK(message.find("2 voxels") != std::string::npos);
    CHECK(message.find("[6, 0, 0], in world space [103, 0, 0]") != std::string::npos);
    CHECK(message.find("inside or outside") != std::string::npos);
    const auto nowhere = ball();
    nowhere->tree().root().setBackground(kNan, false);
    CHECK(refusal<BadValue>(*nowhere).find("the background is NaN") != std::string::npos);
}

TEST_CASE("values that have no sign are meshed as if they were plain inside or outside") {
    Options graded, between, third, optimized;
    graded.grade = true;
    between.voxels = 1.3;
    third.tiger = 3;
    optimized.optimize = 30.0;
    for (const Options& options : {Options(), graded, between, third, optimized}) {
        for (const Nan nan : {Nan::Inside, Nan::Outside}) {
            CAPTURE(int(nan), options.voxels, options.tiger, options.grade);
            const float plain = nan == Nan::Inside ? -3.0f : 3.0f;
            const Meshed bad = meshOf(*riddled(kNan, -kInfinity), as(nan, options));
            requireClean(bad.mesh, bad.report);
            requireIdentical(bad.mesh, meshOf(*riddled(plain, plain), options).mesh);
            CHECK(bad.report.badValues > 100);
        }
    }
}

TEST_CASE("a grid without bad values is meshed as ever, whatever they would be taken for") {
    const Meshed plain = meshOf(*ball());
    CHECK(plain.report.badValues == 0);
    for (const Nan nan : {Nan::Inside, Nan::Outside})
        requireIdentical(meshOf(*ball(), as(nan)).mesh, plain.mesh);
}

TEST_CASE("bad values of a double grid near its own isovalue get the right sign") {
    const auto grid = openvdb::DoubleGrid::create(1e-300);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
            for (int k = 0; k < 12; ++k)
                grid->tree().setValue(Coord(i, j, k), std::numeric_limits<double>::quiet_NaN());
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const Meshed block = meshOf(*grid, as(Nan::Inside));
    requireClean(block.mesh, block.report);
    CHECK(block.report.badValues == 12 * 12 * 12);
    CHECK(refusal<NoSurface>(*grid, as(Nan::Outside)) != "");
}

TEST_CASE(
    "a background that has no sign may be outside, where the class or the user tells which side that is") {
    for (const float background : {kNan, kInfinity, -kInfinity}) {
        const auto grid = ball();
        grid->tree().root().setBackground(background, false);
        requireIdentical(meshOf(*grid, as(Nan::Outside)).mesh, meshOf(*ball()).mesh);
        CHECK(refusal<UnboundedInside>(*grid, as(Nan::Inside)) != "");
        grid->setGridClass(openvdb::GRID_UNKNOWN);
        CHECK(refusal<BadValue>(*grid, as(Nan::Outside)).find("isovalue") != std::string::npos);
        Options told = as(Nan::Outside);
        told.isovalue = 0.0;
        told.inside = Inside::Below;
        requireIdentical(meshOf(*grid, told).mesh, meshOf(*ball()).mesh);
    }
}

TEST_CASE("distances are to the surface that is meshed, bad values or not") {
    const auto grid = ball();
    grid->tree().setValue(Coord(7, 1, 0), kNan);
    CHECK_THROWS_AS(signedDistance(*grid), BadValue);
    const auto distance = openvdb::gridPtrCast<FloatGrid>(signedDistance(*grid, as(Nan::Outside)));
    for (auto value = distance->cbeginValueAll(); value; ++value) REQUIRE(std::isfinite(*value));
}
