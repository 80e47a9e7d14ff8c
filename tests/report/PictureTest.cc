/// @file PictureTest.cc
/// What a report shows is the mesh while that is small enough, and else no more than it may be.
#include "support/Boundary.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include "report/Picture.h"

#include <cmath>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

Picture pictureOf(const openvdb::GridBase& grid, const Options& options, const Report& of,
                  std::int64_t most) {
    return makePicture(grid, options, of, most, nullptr);
}

} // namespace

TEST_CASE("a small mesh is shown as it is, bit for bit") {
    const auto grid = levelSet(torus({0.3, 0.2, 0.1}, 10, 4));
    Options options = atVoxels(1.3);
    options.optimize = 30.0;
    const Meshed meshed = meshOf(*grid, options);
    const Picture picture = pictureOf(*grid, options, meshed.report, meshed.report.tets);
    CHECK(picture.kind == Picture::Kind::Whole);
    requireIdentical(picture.mesh, meshed.mesh);
}

TEST_CASE("of a mesh that is too large the surface is shown as it is, with its worst tets") {
    const auto grid = levelSet(sphere({0.3, 0.2, 0.1}, 20));
    for (const bool optimize : {false, true}) {
        Options options;
        if (optimize) options.optimize = 30.0;
        const Meshed meshed = meshOf(*grid, options);
        const Picture picture = pictureOf(*grid, options, meshed.report, meshed.report.tets / 2);
        CHECK(picture.kind == Picture::Kind::SameSurface);
        CHECK(std::int64_t(picture.mesh.tets.size()) <= meshed.report.tets / 2);
        CHECK(boundaryOf(picture.mesh) == boundaryOf(meshed.mesh));
        CHECK(picture.report.angles.min == meshed.report.angles.min);
        CHECK(picture.report.angles.max == meshed.report.angles.max);
    }
}

TEST_CASE("a mesh whose surface is too large is shown coarser, and never larger than may be") {
    const auto grid = levelSet(sphere({0.3, 0.2, 0.1}, 20));
    Options options;
    options.grade = true;
    options.maxSize = 2.0; // of no use where the spacing is larger
    const Report of = meshOf(*grid, options).report;
    for (const std::int64_t most : {of.tets - 1, of.tets / 8, of.tets / 40, std::int64_t(60)}) {
        const Picture picture = pictureOf(*grid, options, of, most);
        CHECK((picture.kind == Picture::Kind::Coarser || picture.kind == Picture::Kind::SameSurface));
        CHECK(picture.report.tets == std::int64_t(picture.mesh.tets.size()));
        CHECK(picture.report.tets <= most);
        const double doublings = std::log2(picture.report.spacing / of.spacing);
        CHECK(doublings == std::round(doublings));
        CHECK((doublings > 0) == (picture.kind == Picture::Kind::Coarser));
    }
}

TEST_CASE("where no mesh is small enough nothing is shown, and why") {
    const auto grid = levelSet(sphere({0.3, 0.2, 0.1}, 10));
    const Picture picture = pictureOf(*grid, {}, meshOf(*grid).report, 3);
    CHECK(picture.kind == Picture::Kind::None);
    CHECK(picture.mesh.tets.empty());
    CHECK(!picture.why.empty());
}

TEST_CASE("a picture is given up when interrupted") {
    struct Stop final : openvdb::util::NullInterrupter {
        bool wasInterrupted(int) override { return true; }
    };
    const auto grid = levelSet(sphere({0.3, 0.2, 0.1}, 10));
    const Report of = meshOf(*grid).report;
    Stop stop;
    CHECK(makePicture(*grid, {}, of, of.tets, &stop).report.cancelled);
}
