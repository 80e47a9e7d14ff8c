/// @file SurfaceCheck.cc
/// Sorts the edges of a surface, and joins what they join.
#include "SurfaceCheck.h"

#include <fmt/format.h>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace {

using openvdb::Index32;
using openvdb::Vec3d;
using openvdb::Vec3I;

/// An edge of a triangle, from its lower to its higher point.
struct Edge {
    Index32 low, high;
    bool forward; ///< the triangle goes from low to high

    bool isOf(const Edge& other) const { return low == other.low && high == other.high; }
    bool operator<(const Edge& other) const {
        return std::make_pair(low, high) < std::make_pair(other.low, other.high);
    }
};

/// Which points hang together.
class Groups {
public:
    explicit Groups(std::size_t points) : mParent(points) {
        std::iota(mParent.begin(), mParent.end(), Index32(0));
    }
    /// @return the lowest point of the group
    Index32 of(Index32 point) {
        while (mParent[point] != point) point = mParent[point] = mParent[mParent[point]];
        return point;
    }
    void join(Index32 a, Index32 b) {
        a = of(a);
        b = of(b);
        mParent[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<Index32> mParent;
};

std::vector<Edge> edgesOf(const TriangleMesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Index32 a = t[k], b = t[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    }
    tbb::parallel_sort(edges.begin(), edges.end());
    return edges;
}

void judgeEdges(const TriangleMesh& mesh, SurfaceCheck& check) {
    const std::vector<Edge> edges = edgesOf(mesh);
    Groups rims(mesh.points.size());
    std::vector<Index32> onRims;
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const Edge& e) { return !e.isOf(*first); });
        const auto uses = last - first;
        if (uses == 1) {
            ++check.openEdges;
            rims.join(first->low, first->high);
            onRims.push_back(first->low);
        } else if (uses > 2) {
            ++check.nonManifoldEdges;
        } else if (first[0].forward == first[1].forward) {
            ++check.misorientedEdges;
        }
        first = last;
    }
    for (Index32& point : onRims) point = rims.of(point);
    std::sort(onRims.begin(), onRims.end());
    check.holes = std::unique(onRims.begin(), onRims.end()) - onRims.begin();
}

std::vector<Shell> shellsOf(const TriangleMesh& mesh) {
    Groups groups(mesh.points.size());
    for (const Vec3I& t : mesh.triangles) {
        groups.join(t[0], t[1]);
        groups.join(t[1], t[2]);
    }
    constexpr Index32 kNone = ~Index32(0);
    std::vector<Index32> shellOf(mesh.points.size(), kNone);
    std::vector<Shell> shells;
    for (Index32 point = 0; point < mesh.points.size(); ++point) {
        const Index32 lowest = groups.of(point);
        if (lowest == point) { // before all others of its group
            shellOf[point] = Index32(shells.size());
            shells.emplace_back();
        }
    }
    const Vec3d origin = mesh.points[0]; // near, so that little is lost to rounding
    for (const Vec3I& t : mesh.triangles) {
        Shell& shell = shells[shellOf[groups.of(t[0])]];
        shell.triangles.push_back(t);
        const Vec3d a = mesh.points[t[0]] - origin, b = mesh.points[t[1]] - origin,
                    c = mesh.points[t[2]] - origin;
        shell.volume += a.dot(b.cross(c)) / 6.0;
    }
    const auto isEmpty = [](const Shell& shell) { return shell.triangles.empty(); };
    shells.erase(std::remove_if(shells.begin(), shells.end(), isEmpty), shells.end());
    return shells;
}

} // namespace

SurfaceCheck checkSurface(const TriangleMesh& mesh) {
    SurfaceCheck check;
    judgeEdges(mesh, check);
    check.shells = shellsOf(mesh);
    check.crossingTriangles = countCrossing(mesh);
    return check;
}

std::string SurfaceCheck::problems() const {
    std::vector<std::string> found;
    const auto add = [&](std::int64_t count, const char* one, const char* many) {
        if (count > 0) found.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
    };
    if (holes > 0) {
        found.push_back(fmt::format("{} hole{} ({} open edge{})", holes, holes == 1 ? "" : "s", openEdges,
                                    openEdges == 1 ? "" : "s"));
    }
    add(nonManifoldEdges, "edge of more than two triangles", "edges of more than two triangles");
    add(misorientedEdges, "edge between triangles that face opposite ways",
        "edges between triangles that face opposite ways");
    add(crossingTriangles, "triangle that passes through others", "triangles that pass through others");
    return fmt::format("{}", fmt::join(found, ", "));
}
