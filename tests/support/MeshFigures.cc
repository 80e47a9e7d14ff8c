// Finds the faces, edges and points of a mesh by sorting, as tetcheck.py does in numpy.
#include "support/MeshFigures.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdbtet::test {

using openvdb::Vec3d;

namespace {

using Id = std::uint32_t;

/// A face with its corners ascending; odd tells whether sorting turned it over.
struct Face {
    std::array<Id, 3> key;
    std::uint32_t odd;
    bool operator<(const Face& other) const { return key < other.key; }
};

struct Edge {
    Id a, b;
    bool operator<(const Edge& other) const { return a != other.a ? a < other.a : b < other.b; }
    bool operator==(const Edge& other) const { return a == other.a && b == other.b; }
};

Face makeFace(Id a, Id b, Id c) {
    Face face{{a, b, c}, 0};
    const auto order = [&](int i, int j) {
        if (face.key[i] > face.key[j]) {
            std::swap(face.key[i], face.key[j]);
            face.odd ^= 1;
        }
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return face;
}

double det(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return (b - a).cross(c - a).dot(d - a);
}

/// Volume and angles, of a range of tets.
struct Solid {
    const TetMesh& mesh;
    const double precision;
    MeshFigures figures;

    Solid(const TetMesh& m, double p) : mesh(m), precision(p) {}
    Solid(const Solid& other, tbb::split) : mesh(other.mesh), precision(other.precision) {}

    void operator()(const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Tet& t = mesh.tets[i];
            const Vec3d &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]],
                        &d = mesh.points[t[3]];
            const double volume6 = det(a, b, c, d);
            figures.inverted += !(volume6 > 0);
            figures.volume += volume6 / 6;
            for (const double angle : angleOfEdges(a, b, c, d)) {
                figures.minAngle = std::min(figures.minAngle, angle);
                figures.maxAngle = std::max(figures.maxAngle, angle);
                const auto bin = [](double x) { return std::size_t(std::clamp(x / 10, 0.0, 17.0)); };
                ++figures.surelyBelow[bin(angle + precision)];
                ++figures.maybeBelow[bin(angle - precision)];
            }
        }
    }

    void join(const Solid& other) {
        const MeshFigures& o = other.figures;
        figures.inverted += o.inverted;
        figures.volume += o.volume;
        figures.minAngle = std::min(figures.minAngle, o.minAngle);
        figures.maxAngle = std::max(figures.maxAngle, o.maxAngle);
        for (int i = 0; i < 18; ++i) {
            figures.surelyBelow[i] += o.surelyBelow[i];
            figures.maybeBelow[i] += o.maybeBelow[i];
        }
    }
};

/// A face turns by about the error of its corners over the shortest of its heights; two faces, and heights of
/// at least a tenth of an edge, make the factor.
double anglePrecision(const TetMesh& mesh) {
    if (mesh.tets.empty()) return 0;
    double farthest = 0;
    for (const Vec3d& p : mesh.points)
        farthest = std::max({farthest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    const Tet& any = mesh.tets.front();
    const double edge = (mesh.points[any[0]] - mesh.points[any[1]]).length();
    return 1e-9 + 60 * 20 * farthest * std::numeric_limits<double>::epsilon() / edge;
}

void examineSolid(const TetMesh& mesh, MeshFigures& figures) {
    figures.precision = anglePrecision(mesh);
    Solid solid(mesh, figures.precision);
    tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, mesh.tets.size(), 4096), solid);
    figures.inverted = solid.figures.inverted;
    figures.volume = solid.figures.volume;
    figures.minAngle = solid.figures.minAngle;
    figures.maxAngle = solid.figures.maxAngle;
    // From counts a bin to counts below each bin's lower end.
    std::exclusive_scan(solid.figures.surelyBelow.begin(), solid.figures.surelyBelow.end(),
                        figures.surelyBelow.begin(), std::int64_t(0));
    std::exclusive_scan(solid.figures.maybeBelow.begin(), solid.figures.maybeBelow.end(),
                        figures.maybeBelow.begin(), std::int64_t(0));
}

/// @return the boundary triangles, turned as their tets see them from outside.
std::vector<std::array<Id, 3>> examineFaces(const TetMesh& mesh, MeshFigures& figures) {
    std::vector<Face> faces;
    faces.reserve(4 * mesh.tets.size());
    for (const Tet& t : mesh.tets) {
        const Id a = Id(t[0]), b = Id(t[1]), c = Id(t[2]), d = Id(t[3]);
        faces.push_back(makeFace(b, c, d));
        faces.push_back(makeFace(a, d, c));
        faces.push_back(makeFace(a, b, d));
        faces.push_back(makeFace(a, c, b));
    }
    tbb::parallel_sort(faces.begin(), faces.end());
    std::vector<std::array<Id, 3>> boundary;
    for (std::size_t i = 0, next; i < faces.size(); i = next) {
        for (next = i + 1; next < faces.size() && faces[next].key == faces[i].key;) ++next;
        if (next - i > 2) {
            ++figures.overusedFaces;
        } else if (next - i == 2) {
            figures.misorientedFaces += faces[i].odd == faces[i + 1].odd;
        } else {
            auto [a, b, c] = faces[i].key;
            if (faces[i].odd) std::swap(b, c);
            boundary.push_back({a, b, c});
        }
    }
    figures.triangles = std::int64_t(boundary.size());
    return boundary;
}

class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : mParent(n) { std::iota(mParent.begin(), mParent.end(), Id(0)); }
    Id find(Id x) {
        while (mParent[x] != x) x = mParent[x] = mParent[mParent[x]];
        return x;
    }
    void join(Id a, Id b) { mParent[find(a)] = find(b); }

private:
    std::vector<Id> mParent;
};

/// A fan is closed when its link edges, each from a triangle's second corner to its third, form one loop.
bool isOneFan(const Edge* first, const Edge* last) {
    const auto from = [&](Id a) {
        return std::find_if(first, last, [&](const Edge& e) { return e.a == a; });
    };
    Id at = first->a;
    for (const Edge* e = first; e != last; ++e) {
        const Edge* next = from(at);
        if (next == last) return false;
        at = next->b;
        if (at == first->a) return e + 1 == last;
    }
    return false;
}

void examineBoundary(const std::vector<std::array<Id, 3>>& triangles, std::size_t points,
                     MeshFigures& figures) {
    struct Corner {
        Id point;
        Edge link;
        bool operator<(const Corner& other) const {
            return point != other.point ? point < other.point : link < other.link;
        }
    };
    std::vector<Edge> edges;
    std::vector<Corner> corners;
    for (const auto& [a, b, c] : triangles) {
        for (const Edge& e : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
            edges.push_back({std::min(e.a, e.b), std::max(e.a, e.b)});
        corners.push_back({a, {b, c}});
        corners.push_back({b, {c, a}});
        corners.push_back({c, {a, b}});
    }
    tbb::parallel_sort(edges.begin(), edges.end());
    tbb::parallel_sort(corners.begin(), corners.end());

    DisjointSets pieces(points);
    std::int64_t edgeCount = 0, pointCount = 0;
    for (std::size_t i = 0, next; i < edges.size(); i = next) {
        for (next = i + 1; next < edges.size() && edges[next] == edges[i];) ++next;
        figures.nonmanifoldEdges += next - i != 2;
        ++edgeCount;
        pieces.join(edges[i].a, edges[i].b);
    }
    std::vector<Edge> links;
    for (std::size_t i = 0; i < corners.size();) {
        const Id point = corners[i].point;
        links.clear();
        for (; i < corners.size() && corners[i].point == point; ++i) links.push_back(corners[i].link);
        figures.nonmanifoldPoints += !isOneFan(links.data(), links.data() + links.size());
        figures.components += pieces.find(point) == point;
        ++pointCount;
    }
    figures.euler = pointCount - edgeCount + figures.triangles;
}

void examinePoints(const TetMesh& mesh, MeshFigures& figures) {
    std::vector<bool> used(mesh.points.size());
    for (const Tet& t : mesh.tets)
        for (const std::int64_t id : t) used[std::size_t(id)] = true;
    figures.unusedPoints = std::count(used.begin(), used.end(), false);

    std::vector<Vec3d> sorted = mesh.points;
    tbb::parallel_sort(sorted.begin(), sorted.end());
    const auto unique = std::unique(sorted.begin(), sorted.end(), [](const Vec3d& a, const Vec3d& b) {
        return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
    });
    figures.duplicatePoints = sorted.end() - unique;
}

} // namespace

std::array<double, 6> angleOfEdges(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    // At an edge u with the other two corners v and w from its start, the face normals are u x v and u x w;
    // their cross product is u times the tet's volume, six times over.
    const auto angle = [](const Vec3d& u, const Vec3d& v, const Vec3d& w) {
        const Vec3d n = u.cross(v), m = u.cross(w);
        return std::atan2(u.length() * std::abs(n.dot(w)), n.dot(m)) * (180 / 3.14159265358979323846);
    };
    const Vec3d ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
    return {angle(ab, ac, ad),  angle(ac, ab, ad),  angle(ad, ab, ac),
            angle(bc, bd, -ab), angle(bd, bc, -ab), angle(cd, -ac, -bc)};
}

MeshFigures examine(const TetMesh& mesh) {
    MeshFigures figures;
    figures.points = std::int64_t(mesh.points.size());
    figures.tets = std::int64_t(mesh.tets.size());
    if (mesh.points.size() >= std::numeric_limits<Id>::max())
        throw std::length_error("the checker numbers points by 32 bits");
    for (const Tet& t : mesh.tets) {
        bool bad = false;
        for (int i = 0; i < 4; ++i) {
            bad |= t[i] < 0 || t[i] >= figures.points;
            for (int j = 0; j < i; ++j) bad |= t[i] == t[j];
        }
        figures.badIndices += bad;
    }
    for (const Vec3d& p : mesh.points)
        figures.nonFinitePoints += !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
    if (figures.badIndices || figures.nonFinitePoints) return figures;

    examineSolid(mesh, figures);
    examinePoints(mesh, figures);
    examineBoundary(examineFaces(mesh, figures), mesh.points.size(), figures);
    return figures;
}

} // namespace vdbtet::test
