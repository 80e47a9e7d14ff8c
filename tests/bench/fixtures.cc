/// @file fixtures.cc
/// Evaluates the shape in the leaf nodes near its surface only.
#include "bench/fixtures.h"

#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <tbb/parallel_for.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace vdbtet::bench {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using Leaf = FloatGrid::TreeType::LeafNodeType;

constexpr double kTube = 0.1;  // mean radius of the tube
constexpr double kBump = 0.12; // height of the bumps, in kTube
constexpr int kAlong = 10;     // bumps along the ring
constexpr int kAround = 3;     // bumps around the tube
constexpr double kRing = 0.5 - kTube * (1.0 + kBump);
constexpr double kTilt = 25.0 * M_PI / 180.0; // so that no face of it lies along the lattice
constexpr double kHalfWidth = 3.0;
/// Near its surface the distance function is nowhere steeper.
constexpr double kSteepest = 2.0;

struct Sample {
    double value; // of a function that is 0 on the surface
    double slope; // length of its gradient

    double distance() const { return value / slope; }
};

Sample sample(const Vec3d& p) {
    const double y = std::cos(kTilt) * p.y() + std::sin(kTilt) * p.z();
    const double z = std::cos(kTilt) * p.z() - std::sin(kTilt) * p.y();
    const double fromAxis = std::hypot(p.x(), y);
    const double fromRing = std::hypot(fromAxis - kRing, z);
    const double along = kAlong * std::atan2(y, p.x());
    const double around = kAround * std::atan2(z, fromAxis - kRing);
    constexpr double height = kTube * kBump;
    const double value = fromRing - kTube - height * std::cos(along) * std::cos(around);
    const double slopeAlong = height * kAlong * std::sin(along) * std::cos(around) / fromAxis;
    const double slopeAround = height * kAround * std::cos(along) * std::sin(around) / fromRing;
    return {value, std::hypot(1.0, slopeAlong, slopeAround)};
}

/// @return null where the band does not reach the leaf
std::unique_ptr<Leaf> makeLeaf(const Coord& origin, double voxel) {
    constexpr double halfDiagonal = 0.5 * Leaf::DIM * 1.7320508;
    const Vec3d centre = voxel * (origin.asVec3d() + Vec3d(0.5 * Leaf::DIM));
    if (std::abs(sample(centre).value) > kSteepest * voxel * (halfDiagonal + kHalfWidth)) return nullptr;

    const double background = kHalfWidth * voxel;
    auto leaf = std::make_unique<Leaf>(origin, float(background));
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const double distance = sample(voxel * leaf->offsetToGlobalCoord(i).asVec3d()).distance();
        if (std::abs(distance) < background) leaf->setValueOn(i, float(distance));
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
}

} // namespace

FloatGrid::Ptr bumpyTorus(int resolution) {
    if (resolution < 64 || resolution > 4096) throw std::runtime_error("a resolution is from 64 to 4096");
    const double voxel = 1.0 / resolution;
    const int half = resolution / 2 / int(Leaf::DIM) + 2; // leaves from the centre to past the band
    const int side = 2 * half;

    std::vector<std::vector<std::unique_ptr<Leaf>>> columns(std::size_t(side) * side);
    tbb::parallel_for(0, side * side, [&](int xy) {
        for (int z = 0; z < side; ++z) {
            auto leaf =
                makeLeaf(Coord(8 * (xy / side - half), 8 * (xy % side - half), 8 * (z - half)), voxel);
            if (leaf) columns[std::size_t(xy)].push_back(std::move(leaf));
        }
    });

    auto grid = FloatGrid::create(float(kHalfWidth * voxel));
    grid->setName("torus_" + std::to_string(resolution));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    for (auto& column : columns) {
        for (auto& leaf : column) grid->tree().addLeaf(leaf.release());
    }
    openvdb::tools::signedFloodFill(grid->tree());
    return grid;
}

FloatGrid::Ptr ball(int resolution) {
    auto grid = openvdb::tools::createLevelSetSphere<FloatGrid>(
        0.5f * float(resolution), openvdb::Vec3f(0.0f), 1.0f, float(kHalfWidth));
    grid->setName("ball_" + std::to_string(resolution));
    return grid;
}

FloatGrid::Ptr box(int resolution) {
    auto grid = FloatGrid::create(1.0f);
    grid->setName("box_" + std::to_string(resolution));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->sparseFill(openvdb::CoordBBox(Coord(0), Coord(resolution - 1)), -1.0f);
    return grid;
}

} // namespace vdbtet::bench
