/// @file SurfaceVolume.cc
/// One level set of what is solid, less one of the cavities.
#include "SurfaceVolume.h"

#include <vdbtet/Errors.h>

#include <openvdb/tools/Composite.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <fmt/format.h>

#include <tbb/task_arena.h>

#include <algorithm>

namespace {

using openvdb::FloatGrid;
using openvdb::Vec3d;
using openvdb::Vec3I;

constexpr float kHalfWidth = 3.0f; // voxels, as usual

/// Refuse what would take more memory than a machine has: some 40 bytes a voxel of the band.
void requireModest(const TriangleMesh& mesh, double voxel) {
    constexpr double kMostVoxels = 4e9, kLongestSide = 1e6;
    double area = 0.0;
    for (const Vec3I& t : mesh.triangles) {
        const Vec3d &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
        area += 0.5 * (b - a).cross(c - a).length();
    }
    const double voxels = 2.0 * double(kHalfWidth) * area / (voxel * voxel);
    const double side = 256.0 * defaultVoxel(mesh) / voxel;
    if (!(voxels <= kMostVoxels) || !(side <= kLongestSide)) {
        throw vdbtet::BadOption(
            fmt::format("a voxel of {:g} is too small for this surface: its band would have {:.2g} "
                        "voxels; use a larger --voxel-size, the default is {:.4g}",
                        voxel, voxels, defaultVoxel(mesh)));
    }
}

/// The level set of some shells together.
FloatGrid::Ptr levelSetOf(const std::vector<Vec3d>& points, const std::vector<Vec3I>& triangles,
                          const openvdb::math::Transform& transform,
                          openvdb::util::NullInterrupter& interrupter) {
    std::vector<Vec3d> places(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) places[p] = transform.worldToIndex(points[p]);
    const openvdb::tools::QuadAndTriangleDataAdapter<Vec3d, Vec3I> surface(places, triangles);
    FloatGrid::Ptr grid;
    // On one thread: which of two triangles equally near counts may depend on the threads, and farther voxels
    // follow it.
    tbb::task_arena(1).execute([&] {
        grid =
            openvdb::tools::meshToVolume<FloatGrid>(interrupter, surface, transform, kHalfWidth, kHalfWidth);
    });
    return grid;
}

void append(std::vector<Vec3I>& triangles, const Shell& shell) {
    triangles.insert(triangles.end(), shell.triangles.begin(), shell.triangles.end());
}

} // namespace

double defaultVoxel(const TriangleMesh& mesh) {
    const Vec3d sides = boundsOf(mesh).extents();
    return std::max({sides[0], sides[1], sides[2]}) / 256.0;
}

FloatGrid::Ptr surfaceToVolume(const TriangleMesh& mesh, const SurfaceCheck& check, double voxel,
                               openvdb::util::NullInterrupter* interrupter) {
    requireModest(mesh, voxel);
    openvdb::util::NullInterrupter none;
    openvdb::util::NullInterrupter& stop = interrupter ? *interrupter : none;
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);

    std::vector<Vec3I> solid, insideOut, cavities;
    for (const Shell& shell : check.shells) {
        if (shell.volume >= 0.0) append(solid, shell);
    }
    FloatGrid::Ptr grid = levelSetOf(mesh.points, solid, *transform, stop);
    const openvdb::tools::GridSampler<FloatGrid, openvdb::tools::BoxSampler> inside(*grid);
    for (const Shell& shell : check.shells) {
        if (shell.volume >= 0.0) continue;
        const Vec3d& place = mesh.points[shell.triangles[0][0]];
        append(inside.wsSample(place) < 0.0f ? cavities : insideOut, shell);
    }
    if (!insideOut.empty())
        openvdb::tools::csgUnion(*grid, *levelSetOf(mesh.points, insideOut, *transform, stop));
    if (!cavities.empty())
        openvdb::tools::csgDifference(*grid, *levelSetOf(mesh.points, cavities, *transform, stop));

    // Where the outside comes in, voxels that touch the surface may count as inside all the same.
    const float depth = check.closed() ? 0.0f : -float(voxel);
    bool encloses = false;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf && !encloses; ++leaf) {
        const float* values = leaf->buffer().data();
        encloses = std::any_of(values, values + leaf->SIZE, [depth](float value) { return value < depth; });
    }
    if (!encloses && !stop.wasInterrupted()) {
        throw vdbtet::NoSurface(
            check.closed()
                ? fmt::format("the surface encloses nothing that voxels of {:g} resolve; use a smaller "
                              "--voxel-size",
                              voxel)
                : fmt::format("the surface encloses nothing, for it is open: {}; close it, or use voxels "
                              "larger than the holes (--voxel-size)",
                              check.problems()));
    }
    grid->setName("surface");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}
