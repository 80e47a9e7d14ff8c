// The checker finds each fault that a mesh can have.
#include "support/MeshChecker.h"

#include "support/Catch.h"

#include <algorithm>
#include <limits>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Vec3d;

namespace {

TetMesh oneTet() {
    TetMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.tets = {{0, 1, 2, 3}};
    return mesh;
}

/// Two tets on either side of the face 1, 2, 3.
TetMesh twoTets() {
    TetMesh mesh = oneTet();
    mesh.points.push_back({1, 1, 1});
    mesh.tets.push_back({4, 2, 1, 3});
    return mesh;
}

/// Two copies of a tet, the second moved such that it shares the given corners of the first.
TetMesh touching(int shared) {
    TetMesh mesh = oneTet();
    for (const Vec3d& p : oneTet().points) mesh.points.push_back(-p);
    mesh.tets.push_back({4, 6, 5, 7});
    if (shared > 0) mesh.tets[1][0] = 0;
    if (shared > 1) {
        mesh.tets[1] = {0, 1, 6, 7};
        mesh.points[6] = {0, -1, 0};
        mesh.points[7] = {0, 0, -1};
    }
    return mesh;
}

} // namespace

TEST_CASE("the checker measures a tet", "[checker]") {
    const MeshFigures f = examine(oneTet());
    CHECK(f.points == 4);
    CHECK(f.tets == 1);
    CHECK(f.triangles == 4);
    CHECK(f.euler == 2);
    CHECK(f.components == 1);
    CHECK(f.volume == Approx(1.0 / 6));
    CHECK(f.minAngle == Approx(54.7356103172));
    CHECK(f.maxAngle == Approx(90.0));
    CHECK(f.surelyBelow[9] == 3);
    CHECK(f.maybeBelow[9] == 6);
    CHECK(f.inverted + f.overusedFaces + f.misorientedFaces + f.unusedPoints + f.duplicatePoints == 0);
    CHECK(f.nonmanifoldEdges + f.nonmanifoldPoints + f.badIndices + f.nonFinitePoints == 0);
}

TEST_CASE("the checker knows angles beyond a right one", "[checker]") {
    // Corners of a regular tet: every angle is arccos(1/3).
    for (const double angle : angleOfEdges({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}))
        CHECK(angle == Approx(70.5287793655));
    const auto flat = angleOfEdges({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0.01});
    CHECK(*std::max_element(flat.begin(), flat.end()) > 170);
    CHECK(*std::min_element(flat.begin(), flat.end()) < 5);
}

TEST_CASE("the checker joins two tets", "[checker]") {
    const MeshFigures f = examine(twoTets());
    CHECK(f.triangles == 6);
    CHECK(f.euler == 2);
    CHECK(f.misorientedFaces == 0);
    CHECK(f.inverted == 0);
}

TEST_CASE("the checker finds inverted tets and faces seen alike from both sides", "[checker]") {
    TetMesh mesh = twoTets();
    std::swap(mesh.tets[1][0], mesh.tets[1][1]);
    CHECK(examine(mesh).inverted == 1);
    CHECK(examine(mesh).misorientedFaces == 1);
    mesh.points[4] = {0.1, 0.1, 0.1}; // right way round, but inside its neighbour
    CHECK(examine(mesh).inverted == 0);
    CHECK(examine(mesh).misorientedFaces == 1);
    mesh.points[4] = {0.5, 0.5, 0.0};
    CHECK(examine(mesh).inverted == 1); // flat
}

TEST_CASE("the checker finds overused faces", "[checker]") {
    TetMesh mesh = twoTets();
    mesh.points.push_back({2, 2, 2});
    mesh.tets.push_back({5, 2, 1, 3});
    CHECK(examine(mesh).overusedFaces == 1);
}

TEST_CASE("the checker finds points that no tet uses, and points in one place", "[checker]") {
    TetMesh mesh = oneTet();
    mesh.points.push_back({5, 5, 5});
    mesh.points.push_back({5, 5, 5});
    CHECK(examine(mesh).unusedPoints == 2);
    CHECK(examine(mesh).duplicatePoints == 1);
}

TEST_CASE("the checker finds pinched boundaries", "[checker]") {
    const MeshFigures apart = examine(touching(0)), point = examine(touching(1)), edge = examine(touching(2));
    CHECK(apart.components == 2);
    CHECK(apart.nonmanifoldPoints == 0);
    CHECK(point.components == 1);
    CHECK(point.nonmanifoldPoints == 1);
    CHECK(point.nonmanifoldEdges == 0);
    CHECK(edge.components == 1);
    CHECK(edge.nonmanifoldEdges == 1);
    CHECK(edge.nonmanifoldPoints == 2);
}

TEST_CASE("the checker finds indices and coordinates that are none", "[checker]") {
    TetMesh mesh = oneTet();
    mesh.tets[0][2] = 4;
    CHECK(examine(mesh).badIndices == 1);
    mesh.tets[0][2] = 1;
    CHECK(examine(mesh).badIndices == 1);
    mesh = oneTet();
    mesh.points[1][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(examine(mesh).nonFinitePoints == 1);
}
