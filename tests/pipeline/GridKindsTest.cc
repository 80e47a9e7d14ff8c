// Which grids are meshed, and which side of them.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <cmath>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::FloatGrid;

namespace {

constexpr double kPi = 3.14159265358979323846;

FloatGrid::Ptr ball(openvdb::GridClass gridClass = openvdb::GRID_LEVEL_SET) {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 8.2));
    grid->setGridClass(gridClass);
    return grid;
}

/// 0 outside, 1 inside.
FloatGrid::Ptr density(openvdb::GridClass gridClass = openvdb::GRID_FOG_VOLUME) {
    const auto grid = fogVolume(sphere({0.3, -0.2, 0.1}, 8.2), uniformTransform(1.0));
    grid->setGridClass(gridClass);
    return grid;
}

Options atIso(double isovalue, Inside inside = Inside::Automatic) {
    Options options;
    options.isovalue = isovalue;
    options.inside = inside;
    return options;
}

void requireBall(const Meshed& result, double radius) {
    const MeshFigures f = requireClean(result.mesh, result.report);
    requireManifold(f);
    CHECK(f.components == 1);
    CHECK(f.euler == 2);
    CHECK(f.volume == Approx(4.0 / 3 * kPi * radius * radius * radius).epsilon(0.02));
}

} // namespace

TEST_CASE("a grid of doubles gives the mesh of the same grid of floats") {
    const auto floats = levelSet(noiseBall(1, {0.3, -0.2, 0.1}, 12, 3));
    auto doubles = openvdb::DoubleGrid::create(std::make_shared<openvdb::DoubleTree>(floats->tree()));
    doubles->setTransform(floats->transformPtr());
    doubles->setGridClass(floats->getGridClass());
    requireIdentical(meshOf(*doubles).mesh, meshOf(*floats).mesh);

    TetMesh typed;
    volumeToTets(*doubles, typed);
    requireIdentical(typed, meshOf(*doubles).mesh);
}

TEST_CASE("a level set is meshed below zero") {
    const Meshed result = meshOf(*ball());
    CHECK(result.report.isovalue == 0);
    CHECK(result.report.inside == Inside::Below);
    CHECK_FALSE(result.report.insideRule.empty());
    CHECK(result.report.gridName == "fixture");
    requireBall(result, 8.2);
    requireBall(meshOf(*ball(), atIso(-1)), 7.2);
}

TEST_CASE("a fog volume is meshed above a half") {
    const Meshed result = meshOf(*density());
    CHECK(result.report.isovalue == 0.5);
    CHECK(result.report.inside == Inside::Above);
    requireBall(result, 8.2);
    requireBall(meshOf(*density(), atIso(0.75)), 7.2);
}

TEST_CASE("a grid of no class is meshed on the side that the background is not on") {
    for (const auto gridClass : {openvdb::GRID_UNKNOWN, openvdb::GRID_STAGGERED}) {
        const Meshed sdf = meshOf(*ball(gridClass));
        CHECK(sdf.report.isovalue == 0);
        CHECK(sdf.report.inside == Inside::Below);
        requireIdentical(sdf.mesh, meshOf(*ball()).mesh);

        const Meshed fog = meshOf(*density(gridClass));
        CHECK(fog.report.isovalue == 0.5);
        CHECK(fog.report.inside == Inside::Above);
        requireIdentical(fog.mesh, meshOf(*density()).mesh);

        // A signed distance that is positive inside has a negative background.
        const auto positive = negated(*ball(gridClass));
        const Meshed inverse = meshOf(*positive, atIso(0));
        CHECK(inverse.report.inside == Inside::Above);
        requireIdentical(inverse.mesh, sdf.mesh);
    }
}

TEST_CASE("the inside can be asked for") {
    const auto positive = negated(*ball());
    requireIdentical(meshOf(*positive, atIso(0, Inside::Above)).mesh, meshOf(*ball()).mesh);
    requireIdentical(meshOf(*ball(), atIso(0, Inside::Below)).mesh, meshOf(*ball()).mesh);
}

TEST_CASE("the active mask is not consulted") {
    const Meshed expected = meshOf(*ball());
    const auto none = ball(), all = ball();
    none->tree().voxelizeActiveTiles();
    for (auto it = none->beginValueOn(); it; ++it) it.setValueOff();
    REQUIRE(none->activeVoxelCount() == 0);
    requireIdentical(meshOf(*none).mesh, expected.mesh);

    for (auto it = all->beginValueOff(); it; ++it)
        if (*it < 0) it.setActiveState(true);
    REQUIRE(all->activeVoxelCount() > ball()->activeVoxelCount());
    requireIdentical(meshOf(*all).mesh, expected.mesh);
}

TEST_CASE("tiles and the voxels that they stand for give one mesh") {
    const auto dense = levelSet(sphere({0.3, -0.2, 0.1}, 21));
    const auto sparse = dense->deepCopy();
    dense->tree().voxelizeActiveTiles();
    for (int x = -24; x < 24; x += 8)
        for (int y = -24; y < 24; y += 8)
            for (int z = -24; z < 24; z += 8) dense->tree().touchLeaf(openvdb::Coord(x, y, z));
    REQUIRE(dense->tree().leafCount() > sparse->tree().leafCount());
    requireIdentical(meshOf(*dense).mesh, meshOf(*sparse).mesh);
}

TEST_CASE("a surface between a tile and its neighbour is found") {
    for (const bool active : {false, true}) {
        const Meshed leafSized = meshOf(*constantTiles(8, {{0, 0, 0}, {8, 0, 0}, {64, 64, 64}}, active));
        const MeshFigures f = requireClean(leafSized.mesh, leafSized.report);
        CHECK(f.components == 2);
        // Values of -3 and 3 meet half way: boxes of 16 by 8 by 8 and of 8 cubed, less their edges.
        CHECK(f.volume == Approx(1024 + 512).epsilon(0.05));
    }
    const auto grid = constantTiles(128, {{0, 0, 0}}, false);
    const Meshed nodeSized = meshOf(*grid, atVoxels(4.0));
    const MeshFigures f = requireClean(nodeSized.mesh, nodeSized.report);
    CHECK(f.components == 1);
    CHECK(f.volume == Approx(128.0 * 128 * 128).epsilon(0.02));
}

TEST_CASE("a surface almost a voxel away from the only leaf is found") {
    // Three voxels a side in the corner of a leaf, of -3 in a background of 0.1.
    const auto grid = openvdb::FloatGrid::create(0.1f);
    grid->tree().touchLeaf(openvdb::Coord(0));
    grid->fill(openvdb::CoordBBox::createCube(openvdb::Coord(0), 3), -3.0f);
    const Meshed result = meshOf(*grid, atVoxels(0.1));
    const MeshFigures f = requireClean(result.mesh, result.report);
    requireManifold(f);
    CHECK(f.components == 1);
    CHECK(f.euler == 2);
    const double reach = 3 / 3.1;
    CHECK(result.report.bounds.min().eq(openvdb::Vec3d(-reach), 0.02));
    CHECK(result.report.bounds.max().eq(openvdb::Vec3d(2 + reach), 0.02));
}

TEST_CASE("two shapes far apart are two meshes") {
    // Memory for the box between them would be some 1e15 bytes.
    const Meshed result = meshOf(*levelSet(twoBalls({0.3, -0.2, 0.1}, 6.2, 1e5)));
    const MeshFigures f = requireClean(result.mesh, result.report);
    CHECK(f.components == 2);
    CHECK(f.euler == 4);
    CHECK(f.volume == Approx(2 * 4.0 / 3 * kPi * 6.2 * 6.2 * 6.2).epsilon(0.03));
}

TEST_CASE("any affine transform gives positive tets and the right volume") {
    const Vec3d centre(0.3, -0.2, 0.1);
    const auto unit = levelSet(sphere(centre, 9.2));
    const auto transforms = {rotatedTransform(0.25),  shearedTransform(0.25),
                             mirroredTransform(0.25), nonuniformTransform({0.25, 0.5, 0.2}),
                             uniformTransform(3e-5),  uniformTransform(1e7, Vec3d(3e8))};
    for (const auto& transform : transforms) {
        // The same voxels elsewhere: the ball becomes an ellipsoid.
        const auto grid = unit->deepCopy();
        grid->setTransform(transform);
        const openvdb::Mat4d m = transform->baseMap()->getAffineMap()->getMat4();
        const double det = std::abs(m.getMat3().det());
        const double radius = 9.2 * std::cbrt(det);
        for (const double voxels : {1.0, 0.7}) requireBall(meshOf(*grid, atVoxels(voxels)), radius);
    }
}

TEST_CASE("a mirrored transform gives the mirrored mesh") {
    const auto grid = levelSet(noiseBall(3, {0.21, -0.34, 0.13}, 11, 4));
    const auto mirrored = grid->deepCopy();
    mirrored->setTransform(mirroredTransform(1.0));
    TetMesh expected = meshOf(*grid, raw()).mesh;
    for (openvdb::Vec3d& p : expected.points) p.x() = -p.x();
    requireSame(meshOf(*mirrored, raw()).mesh, expected, 1e-6);
}
