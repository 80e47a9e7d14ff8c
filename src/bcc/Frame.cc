/// @file Frame.cc
/// The lattice's axes by Gram-Schmidt, free of rounding where they fall on the voxel's.
#include "bcc/Frame.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace vdbtet {

using openvdb::Mat3d;
using openvdb::Vec3d;

namespace {

[[noreturn]] void throwSingular() {
    throw UnsupportedGrid("the transform is singular or not finite; give the grid another one");
}

/// The columns of the transform's linear part: the world vectors of the three voxel edges.
std::array<Vec3d, 3> voxelEdges(const openvdb::math::Transform& transform) {
    if (!transform.isLinear()) {
        throw UnsupportedGrid(
            "the transform is a frustum or otherwise not affine; resample the grid to a linear "
            "transform first");
    }
    const auto map = transform.baseMap();
    std::array<Vec3d, 3> edges;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d unit(0.0);
        unit[axis] = 1.0;
        edges[axis] = map->applyJacobian(unit);
        const double length = edges[axis].length();
        if (!(length > 0.0) || !std::isfinite(length)) throwSingular();
    }
    return edges;
}

/// Rounding alone keeps an entry from an integer: remove it, so that lattice and voxel centres coincide
/// exactly.
double snapped(double x) {
    const double nearest = std::round(x);
    return std::abs(x - nearest) <= 1e-12 * std::max(1.0, std::abs(x)) ? nearest : x;
}

Mat3d snapped(Mat3d m) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) m(i, j) = snapped(m(i, j));
    }
    return m;
}

} // namespace

double shortestVoxelEdge(const openvdb::math::Transform& transform) {
    const auto edges = voxelEdges(transform);
    return std::min({edges[0].length(), edges[1].length(), edges[2].length()});
}

Frame makeFrame(const openvdb::math::Transform& transform, double spacing) {
    if (!(spacing > 0.0) || !std::isfinite(spacing)) throw BadOption("the spacing must be a positive length");
    const auto edges = voxelEdges(transform);
    // All in units of the spacing, so that voxels of 1e-20 or 1e+20 neither underflow nor overflow.
    std::array<Vec3d, 3> e;
    for (int i = 0; i < 3; ++i) {
        e[i] = edges[i] / spacing;
        // Products of three, and their inverses, must be numbers.
        constexpr double kMost = 1e60;
        const double length = e[i].length();
        if (!(length < kMost && length > 1.0 / kMost)) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "a voxel has an edge %.3g times as long as the spacing; give the grid another "
                          "transform, or mesh it with another spacing",
                          length);
            throw UnsupportedGrid(text);
        }
    }
    const double lengths = e[0].length() * e[1].length() * e[2].length();
    const double det = e[0].dot(e[1].cross(e[2]));
    if (!(std::abs(det) > 1e-12 * lengths) || !std::isfinite(det)) throwSingular();

    const Vec3d x = e[0].unit();
    const Vec3d y = (e[1] - x * x.dot(e[1])).unit();
    const Vec3d z = x.cross(y);
    const Mat3d rotation = snapped(Mat3d(x, y, z, /*rows=*/false));

    const Mat3d voxel(e[0], e[1], e[2], /*rows=*/false);
    Frame frame;
    frame.spacing = spacing;
    frame.origin = transform.indexToWorld(Vec3d(0.0));
    if (!std::isfinite(frame.origin.x() + frame.origin.y() + frame.origin.z()))
        throw UnsupportedGrid("the transform's translation is not finite; give the grid another transform");
    frame.toWorld = rotation * spacing;
    frame.toIndex = snapped(voxel.inverse() * rotation);
    frame.fromIndex = frame.toIndex.inverse();
    return frame;
}

} // namespace vdbtet
