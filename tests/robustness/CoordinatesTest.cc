// Transforms and coordinates that make no sense are refused, each with a line of its own.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <limits>
#include <string>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;
using openvdb::FloatGrid;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();
constexpr int kLast = std::numeric_limits<int>::max(), kFirst = std::numeric_limits<int>::min();

FloatGrid::Ptr ball() { return levelSet(sphere({0.3, -0.2, 0.1}, 8.2)); }

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("transforms that are not finite are refused") {
    for (const double bad : {kNan, kInfinity}) {
        CAPTURE(bad);
        const auto scaled = ball();
        scaled->setTransform(openvdb::math::Transform::createLinearTransform(bad));
        // Of a spacing given or derived.
        Options given;
        given.spacing = 1.0;
        CHECK(contains(refusal<UnsupportedGrid>(*scaled), "transform"));
        CHECK(contains(refusal<UnsupportedGrid>(*scaled, given), "transform"));
    }
}

TEST_CASE("transforms that are nearly flat are refused") {
    const auto flat = ball();
    flat->setTransform(affineTransform({1, 0, 0}, {0, 1, 0}, {1, 1, 1e-13}));
    CHECK(contains(refusal<UnsupportedGrid>(*flat), "singular"));
}

TEST_CASE("voxels far longer than wide, or than the spacing, are refused") {
    for (const double length : {1e-200, 1e-105, 1e105, 1e200}) {
        CAPTURE(length);
        Options options;
        options.spacing = length;
        CHECK(contains(refusal<UnsupportedGrid>(*ball(), options), "times as long as the spacing"));
    }
    for (const double length : {1e70, 1e105}) {
        CAPTURE(length);
        const auto unlike = ball();
        const openvdb::math::MapBase::Ptr scale(
            new openvdb::math::ScaleMap(openvdb::Vec3d(1.0, 1.0, length)));
        unlike->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(scale)));
        CHECK(contains(refusal<UnsupportedGrid>(*unlike), "times as long as the spacing"));
    }
}

TEST_CASE("shapes at the ends of 32-bit coordinates are refused") {
    for (int axis = 0; axis < 3; ++axis) {
        for (const int end : {kLast - 20, kFirst + 20}) {
            Coord by(0);
            by[axis] = end;
            CAPTURE(axis, end);
            for (const double voxels : {1.0, 1.3})
                CHECK(contains(refusal<TooLarge>(*shifted(*ball(), by), atVoxels(voxels)), "32-bit"));
        }
    }
    for (const int end : {kLast - 127, kFirst})
        CHECK(contains(refusal<TooLarge>(*constantTiles(128, {{0, end, 0}}, true)), "32-bit"));
    const auto root = FloatGrid::create(3.0f);
    root->setGridClass(openvdb::GRID_LEVEL_SET);
    root->tree().addTile(3, Coord(kFirst, 0, 0), -3.0f, true);
    CHECK(contains(refusal<TooLarge>(*root), "32-bit"));
}

TEST_CASE("shapes near the ends of 32-bit coordinates are meshed as anywhere") {
    const Meshed here = meshOf(*ball());
    for (const int far : {(kLast & ~7) - 160, (kFirst & ~7) + 160}) {
        const Meshed there = meshOf(*shifted(*ball(), Coord(far)));
        CHECK(there.report.tets == here.report.tets);
        CHECK(there.report.angles.min == here.report.angles.min);
        CHECK(there.report.angles.max == here.report.angles.max);
    }
}
