// What holds for every mesh: the checker's judgement, the bounds, and the symmetries of the lattice.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <openvdb/tools/Interpolation.h>

#include <cmath>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;

namespace {

Options atIso(double isovalue, double voxels) {
    Options options = atVoxels(voxels);
    options.isovalue = isovalue;
    return options;
}

void requireCleanAt(const openvdb::GridBase& grid, const Options& options) {
    CAPTURE(options.voxels, options.tiger, options.isovalue.value_or(-999));
    const Meshed result = meshOf(grid, options);
    requireClean(result.mesh, result.report);
}

/// The same mesh with every point moved.
template <typename Move>
TetMesh movedMesh(TetMesh mesh, const Move& move) {
    for (openvdb::Vec3d& p : mesh.points) p = move(p);
    return mesh;
}

/// A shape about the origin without a symmetry, so that no tie rule comes in.
openvdb::FloatGrid::Ptr lopsided(double scale = 1) {
    return levelSet(noiseBall(3, scale * Vec3d(0.21, -0.34, 0.13), scale * 11, scale * 4));
}

} // namespace

TEST_CASE("every mesh is clean and in its bounds: resolved shapes", "[property]") {
    const Shape shapes[] = {sphere({0.1, 0.2, 0.3}, 11.3), torus({0.4, -0.2, 0.1}, 12, 5),
                            box({-9.3, -7.1, -8.2}, {8.4, 9.9, 7.7}), gyroidBall({0, 0, 0}, 14, 14, 4)};
    for (const Shape& shape : shapes) {
        for (const double halfWidth : {1.5, 6.0}) {
            const auto grid = levelSet(shape, 1.0, halfWidth);
            for (const double voxels : {0.7, 1.0, 1.9, 4.1}) requireCleanAt(*grid, atIso(0.0, voxels));
            requireCleanAt(*grid, atIso(-0.7, 1.0));
            requireCleanAt(*grid, atIso(1.1, 1.3));
        }
    }
}

TEST_CASE("every mesh is clean and in its bounds: noise", "[property]") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (const double feature : {1.0, 2.0, 4.0}) {
            const auto grid = levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 10, feature));
            for (const double voxels : {0.7, 1.0, 2.3})
                for (const int tiger : {1, 2, 3}) requireCleanAt(*grid, atVoxels(voxels, tiger));
        }
    }
}

TEST_CASE("every mesh is clean and in its bounds: random signs", "[property]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto signs = randomSigns(14, seed), cuts = randomCuts(10, seed, 0.7);
        for (const int tiger : {1, 2, 3}) {
            for (const double voxels : {0.5, 1.0, 1.7}) requireCleanAt(*signs, atVoxels(voxels, tiger));
            requireCleanAt(*cuts, atVoxels(2.0, tiger));
        }
    }
}

TEST_CASE("every mesh is clean and in its bounds: sheets thinner than a voxel", "[property]") {
    for (const double thickness : {0.1, 0.5, 1.0, 1.5})
        for (const double z : {0.0, 0.25, 0.5})
            for (const double voxels : {0.4, 1.0}) {
                CAPTURE(thickness, z, voxels);
                try {
                    const auto grid = levelSet(sheet({0.3, 0.1, z}, 9.2, thickness));
                    const Meshed result = meshOf(*grid, atVoxels(voxels));
                    requireClean(result.mesh, result.report);
                } catch (const NoSurface&) {
                    // No vertex is inside; or one layer of them, which all move onto the surface.
                    CHECK(thickness < 1.5);
                }
            }
}

TEST_CASE("version 1 makes no extra flips and promises the weaker bound", "[property]") {
    std::int64_t extra = 0;
    for (const std::uint64_t seed : {4, 5, 10}) {
        const auto grid = randomCuts(12, seed, 0.7);
        const Report one = meshOf(*grid, atVoxels(2.0, 1)).report,
                     two = meshOf(*grid, atVoxels(2.0, 2)).report;
        CHECK(one.tiger == 1);
        CHECK(two.tiger == 2);
        CHECK(one.extraFlips + one.lastResortFlips + one.conflicts == 0);
        CHECK(one.angleMin == 8.54);
        CHECK(one.angleMax == 164.18);
        CHECK(one.activeFlips == two.activeFlips);
        CHECK(one.cutEdges == two.cutEdges);
        extra += two.extraFlips;
    }
    CHECK(extra > 0);
}

TEST_CASE("points lie on the trilinear isosurface or on the lattice", "[property]") {
    for (const double voxels : {0.7, 1.0, 2.0}) {
        const auto grid = lopsided();
        const Meshed result = meshOf(*grid, atVoxels(voxels));
        const double spacing = result.report.spacing;
        std::int64_t moved = 0;
        double farthest = 0;
        for (const openvdb::Vec3d& p : result.mesh.points) {
            const openvdb::Vec3d lattice = p / spacing;
            double offA = 0, offB = 0;
            for (int axis = 0; axis < 3; ++axis) {
                offA = std::max(offA, std::abs(lattice[axis] - std::round(lattice[axis])));
                offB = std::max(offB, std::abs(lattice[axis] - 0.5 - std::round(lattice[axis] - 0.5)));
            }
            const double value = openvdb::tools::BoxSampler::sample(grid->tree(), p);
            if (std::min(offA, offB) < 1e-9) {
                CHECK(value <= 1e-6);
            } else {
                ++moved;
                farthest = std::max(farthest, std::abs(value));
            }
        }
        CHECK(moved > 100);
        CHECK(farthest < 1e-5);
    }
}

TEST_CASE("a grid moved by a tile gives the mesh moved by a tile", "[property]") {
    const auto grid = lopsided();
    const Meshed before = meshOf(*grid, raw());
    for (const Coord& by : {Coord(8, 0, 0), Coord(-8, 16, -24), Coord(128, 8, -4096)}) {
        const Meshed after = meshOf(*shifted(*grid, by), raw());
        requireSame(after.mesh, movedMesh(before.mesh, [&](const auto& p) { return p + by.asVec3d(); }),
                    1e-6);
    }
    // Also by less than a tile: the lattice is the same, though its tiles are others.
    const Coord by(3, -5, 1);
    requireSame(meshOf(*shifted(*grid, by), raw()).mesh,
                movedMesh(before.mesh, [&](const auto& p) { return p + by.asVec3d(); }), 1e-6);
}

TEST_CASE("a grid turned or mirrored about its axes gives the mesh turned or mirrored", "[property]") {
    const auto grid = lopsided();
    for (const double voxels : {1.0, 1.4}) {
        const Meshed before = meshOf(*grid, raw(atVoxels(voxels)));
        for (const bool cycle : {false, true}) {
            for (int mirrored = 0; mirrored < 8; ++mirrored) {
                const std::array<bool, 3> mirror{bool(mirrored & 1), bool(mirrored & 2), bool(mirrored & 4)};
                const auto move = [&](const openvdb::Vec3d& p) {
                    openvdb::Vec3d q = cycle ? openvdb::Vec3d(p.z(), p.x(), p.y()) : p;
                    for (int axis = 0; axis < 3; ++axis)
                        if (mirror[axis]) q[axis] = -q[axis];
                    return q;
                };
                const Meshed after = meshOf(*turned(*grid, cycle, mirror), raw(atVoxels(voxels)));
                requireSame(after.mesh, movedMesh(before.mesh, move), 1e-6);
                CHECK(examine(after.mesh).volume == Approx(examine(before.mesh).volume));
            }
        }
    }
}

TEST_CASE("the spacing is a world length, or so many of the shortest voxel edges", "[property]") {
    const auto grid = levelSet(sphere({0.1, 0.2, 0.3}, 4.1), nonuniformTransform({0.5, 0.4, 0.7}));
    Options options;
    options.voxels = 1.5;
    const Meshed byVoxels = meshOf(*grid, options);
    CHECK(byVoxels.report.voxelSize == Approx(0.4));
    CHECK(byVoxels.report.spacing == Approx(0.6));
    options.spacing = byVoxels.report.spacing;
    options.voxels = 99; // ignored where a spacing is given
    requireIdentical(meshOf(*grid, options).mesh, byVoxels.mesh);
    CHECK(meshOf(*grid).report.spacing == Approx(0.4));
}

TEST_CASE("volumes converge to the shape's with the spacing", "[property]") {
    const auto grid = levelSet(sphere({0.1, 0.2, 0.3}, 14.3));
    const double exact = 4.0 / 3 * 3.14159265358979 * 14.3 * 14.3 * 14.3;
    double last = 1;
    for (const double voxels : {4.0, 2.0, 1.0}) {
        const double error = 1 - examine(meshOf(*grid, atVoxels(voxels)).mesh).volume / exact;
        CHECK(std::abs(error) < 0.02 * voxels * voxels / 4);
        CHECK(std::abs(error) < last);
        last = std::abs(error);
    }
}
