#include "support/Boundary.h"

#include <algorithm>

namespace vdbtet::test {

namespace {

/// A face, and its corners in ascending order.
struct Face {
    std::array<std::int64_t, 3> key, corners;
};

} // namespace

std::vector<Triangle> boundaryOf(const TetMesh& mesh) {
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
        if (end == i + 1) {
            Triangle triangle;
            for (std::size_t c = 0; c < 3; ++c) {
                const openvdb::Vec3d& p = mesh.points[std::size_t(faces[i].corners[c])];
                triangle[c] = {p.x(), p.y(), p.z()};
            }
            std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
            triangles.push_back(triangle);
        }
        i = end;
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

} // namespace vdbtet::test
