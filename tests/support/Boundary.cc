#include "support/Boundary.h"

#include <algorithm>

namespace vdbtet::test {

namespace {

/// A face, and its corners in ascending order.
struct Face {
    Triangle key, corners;
};

} // namespace

std::vector<Corners> cornersOf(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
    std::vector<Corners> all;
    all.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
        Corners corners;
        for (std::size_t c = 0; c < 3; ++c) {
            const openvdb::Vec3d& p = mesh.points[std::size_t(triangle[c])];
            corners[c] = {p.x(), p.y(), p.z()};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.push_back(corners);
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<Corners> boundaryOf(const TetMesh& mesh) {
    // The faces opposite to each vertex, counter-clockwise from outside.
    constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    std::vector<Face> faces;
    faces.reserve(4 * mesh.tets.size());
    for (const Tet& tet : mesh.tets) {
        for (const auto& f : kFaces) {
            Face face;
            face.corners = {tet[std::size_t(f[0])], tet[std::size_t(f[1])], tet[std::size_t(f[2])]};
            face.key = face.corners;
            std::sort(face.key.begin(), face.key.end());
            faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].key == faces[i].key) ++end;
        if (end == i + 1) triangles.push_back(faces[i].corners);
        i = end;
    }
    return cornersOf(mesh, triangles);
}

} // namespace vdbtet::test
