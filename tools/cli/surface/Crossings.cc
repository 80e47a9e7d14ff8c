/// @file Crossings.cc
/// Triangles of a surface that pass through each other, found by a tree of boxes.
#include "SurfaceCheck.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <functional>

namespace {

using openvdb::Vec3d;
using openvdb::Vec3I;
using Box = openvdb::BBoxd;

/// A binary tree over triangles in the order of a space-filling curve; node n has the children 2n and 2n + 1.
class BoxTree {
public:
    explicit BoxTree(const TriangleMesh& mesh) : mMesh(mesh), mSorted(sorted(mesh)) {
        while (mLeaves * kLeafSize < mSorted.size()) mLeaves *= 2;
        mBoxes.resize(2 * mLeaves);
        tbb::parallel_for(std::size_t(0), mLeaves, [&](std::size_t leaf) {
            forEachOf(leaf, [&](std::uint32_t t) { mBoxes[mLeaves + leaf].expand(boxOf(t)); });
        });
        for (std::size_t node = mLeaves - 1; node > 0; --node) {
            mBoxes[node] = mBoxes[2 * node];
            mBoxes[node].expand(mBoxes[2 * node + 1]);
        }
    }

    /// @return whether @a test(t) holds for a triangle t whose box meets @a box.
    template <typename Test>
    bool any(const Box& box, const Test& test, std::size_t node = 1) const {
        if (mBoxes[node].empty() || !mBoxes[node].hasOverlap(box)) return false;
        if (node < mLeaves) return any(box, test, 2 * node) || any(box, test, 2 * node + 1);
        bool found = false;
        forEachOf(node - mLeaves,
                  [&](std::uint32_t t) { found = found || (boxOf(t).hasOverlap(box) && test(t)); });
        return found;
    }

    Box boxOf(std::uint32_t triangle) const { return boxOf(mMesh, triangle); }

private:
    static constexpr std::size_t kLeafSize = 4;

    static Box boxOf(const TriangleMesh& mesh, std::uint32_t triangle) {
        Box box;
        for (int k = 0; k < 3; ++k) box.expand(mesh.points[mesh.triangles[triangle][k]]);
        return box;
    }

    /// The bits of x, y and z in turns: a Morton code.
    static std::uint64_t interleaved(const Vec3d& unit) {
        std::uint64_t code = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto number = std::uint64_t(unit[axis] * 0x1fffff);
            for (int bit = 0; bit < 21; ++bit) code |= (number >> bit & 1) << (3 * bit + axis);
        }
        return code;
    }

    static std::vector<std::uint32_t> sorted(const TriangleMesh& mesh) {
        const openvdb::BBoxd bounds = boundsOf(mesh);
        Vec3d scale = bounds.extents();
        for (int axis = 0; axis < 3; ++axis) scale[axis] = scale[axis] > 0.0 ? 1.0 / scale[axis] : 0.0;
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(mesh.triangles.size());
        tbb::parallel_for(std::size_t(0), keyed.size(), [&](std::size_t t) {
            const Vec3d centre = boxOf(mesh, std::uint32_t(t)).getCenter();
            Vec3d unit = (centre - bounds.min()) * scale;
            for (int axis = 0; axis < 3; ++axis) unit[axis] = std::clamp(unit[axis], 0.0, 1.0);
            keyed[t] = {interleaved(unit), std::uint32_t(t)};
        });
        tbb::parallel_sort(keyed.begin(), keyed.end());
        std::vector<std::uint32_t> order(keyed.size());
        for (std::size_t i = 0; i < keyed.size(); ++i) order[i] = keyed[i].second;
        return order;
    }

    template <typename Visit>
    void forEachOf(std::size_t leaf, const Visit& visit) const {
        const std::size_t end = std::min((leaf + 1) * kLeafSize, mSorted.size());
        for (std::size_t i = leaf * kLeafSize; i < end; ++i) visit(mSorted[i]);
    }

    const TriangleMesh& mMesh;
    std::vector<std::uint32_t> mSorted;
    std::size_t mLeaves = 1;
    std::vector<Box> mBoxes;
};

using Corners = Vec3d[3];

/// The side of the plane through a triangle that @a point is on; 0 if rounding may have decided it.
int side(const Corners& triangle, const Vec3d& point) {
    const Vec3d u = triangle[1] - triangle[0], v = triangle[2] - triangle[0], w = point - triangle[0];
    const double volume = u.cross(v).dot(w), tolerance = 1e-12 * u.length() * v.length() * w.length();
    return volume > tolerance ? 1 : volume < -tolerance ? -1 : 0;
}

/// Whether the segment from @a p to @a q passes through the inside of the triangle.
bool passesThrough(const Vec3d& p, const Vec3d& q, const Corners& triangle) {
    if (side(triangle, p) * side(triangle, q) != -1) return false;
    int sides[3];
    for (int k = 0; k < 3; ++k) sides[k] = side({p, q, triangle[k]}, triangle[(k + 1) % 3]);
    return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}

/// Whether an edge of one passes through the other, edges at common points left out.
bool cross(const TriangleMesh& mesh, const Vec3I& a, const Vec3I& b) {
    const auto has = [](const Vec3I& t, openvdb::Index32 point) {
        return t[0] == point || t[1] == point || t[2] == point;
    };
    Corners corners[2];
    for (int k = 0; k < 3; ++k) {
        corners[0][k] = mesh.points[a[k]];
        corners[1][k] = mesh.points[b[k]];
    }
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if (!has(b, a[k]) && !has(b, a[next]) && passesThrough(corners[0][k], corners[0][next], corners[1]))
            return true;
        if (!has(a, b[k]) && !has(a, b[next]) && passesThrough(corners[1][k], corners[1][next], corners[0]))
            return true;
    }
    return false;
}

} // namespace

std::int64_t countCrossing(const TriangleMesh& mesh) {
    const BoxTree tree(mesh);
    return tbb::parallel_reduce(
        tbb::blocked_range<std::uint32_t>(0, std::uint32_t(mesh.triangles.size()), 256), std::int64_t(0),
        [&](const auto& range, std::int64_t count) {
            for (std::uint32_t t = range.begin(); t != range.end(); ++t) {
                const Vec3I& triangle = mesh.triangles[t];
                count += tree.any(tree.boxOf(t), [&](std::uint32_t other) {
                    return other != t && cross(mesh, triangle, mesh.triangles[other]);
                });
            }
            return count;
        },
        std::plus<>());
}
