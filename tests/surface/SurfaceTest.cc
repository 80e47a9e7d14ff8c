// Closed triangle surfaces become level sets, and what is wrong with them is told.
#include "support/Catch.h"
#include "support/MeshChecker.h"
#include "support/TempFolder.h"
#include "surface/SurfaceVolume.h"

#include <vdbtet/Errors.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Vec3d;
using openvdb::Vec3I;

namespace {

/// Add the surface of a box, facing outwards unless @a inwards.
void addBox(TriangleMesh& mesh, const Vec3d& low, const Vec3d& high, bool inwards = false) {
    const auto first = openvdb::Index32(mesh.points.size());
    for (int corner = 0; corner < 8; ++corner) {
        mesh.points.emplace_back((corner & 4 ? high : low)[0], (corner & 2 ? high : low)[1],
                                 (corner & 1 ? high : low)[2]);
    }
    const openvdb::Index32 quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& q : quads) {
        for (const Vec3I t : {Vec3I(q[0], q[1], q[2]), Vec3I(q[0], q[2], q[3])}) {
            mesh.triangles.push_back(inwards ? Vec3I(first + t[0], first + t[2], first + t[1])
                                             : Vec3I(first + t[0], first + t[1], first + t[2]));
        }
    }
}

TriangleMesh box(const Vec3d& low, const Vec3d& high, bool inwards = false) {
    TriangleMesh mesh;
    addBox(mesh, low, high, inwards);
    return mesh;
}

MeshFigures meshed(const TriangleMesh& surface, double voxel) {
    const auto grid = surfaceToVolume(surface, checkSurface(surface), voxel);
    TetMesh mesh;
    const Report report = volumeToTets(*grid, mesh);
    return requireClean(mesh, report);
}

std::string write(const TempFolder& folder, const std::string& name, const std::string& bytes) {
    std::ofstream(folder.file(name), std::ios::binary) << bytes;
    return folder.file(name);
}

template <typename T>
void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

const TriangleMesh kCube = box(Vec3d(0), Vec3d(1));

std::string asObj() {
    std::ostringstream out;
    for (const Vec3d& p : kCube.points) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    out << "vn 0 0 1\n"; // normals split points, which must be joined again
    for (std::size_t t = 0; t < kCube.triangles.size(); t += 2) {
        const Vec3I &a = kCube.triangles[t], &b = kCube.triangles[t + 1];
        out << "f " << a[0] + 1 << "//1 " << a[1] + 1 << "//1 " << a[2] + 1 << "//1 " << b[2] + 1 << "//1\n";
    }
    return out.str();
}

std::string asPly(bool binary) {
    std::ostringstream head;
    head << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex 8\n"
         << "property float x\nproperty float y\nproperty float z\nelement face 12\n"
         << "property list uchar int vertex_indices\nend_header\n";
    std::string out = head.str();
    std::ostringstream text;
    for (const Vec3d& p : kCube.points) {
        text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        if (binary)
            for (int axis = 0; axis < 3; ++axis) put(out, float(p[axis]));
    }
    for (const Vec3I& t : kCube.triangles) {
        text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
        if (!binary) continue;
        put(out, std::uint8_t(3));
        for (int k = 0; k < 3; ++k) put(out, std::int32_t(t[k]));
    }
    return binary ? out : out + text.str();
}

std::string asStl(bool binary) {
    std::string out(80, ' ');
    put(out, std::uint32_t(kCube.triangles.size()));
    std::ostringstream text;
    text << "solid cube\n";
    for (const Vec3I& t : kCube.triangles) {
        text << "facet normal 0 0 0\nouter loop\n";
        for (int k = 0; k < 3; ++k) put(out, 0.0f);
        for (int k = 0; k < 3; ++k) {
            const Vec3d& p = kCube.points[t[k]];
            text << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
            for (int axis = 0; axis < 3; ++axis) put(out, float(p[axis]));
        }
        text << "endloop\nendfacet\n";
        put(out, std::uint16_t(0));
    }
    text << "endsolid cube\n";
    return binary ? out : text.str();
}

} // namespace

TEST_CASE("Surfaces are read from each format, text and binary, with points in one place made one") {
    const TempFolder folder;
    const std::pair<const char*, std::string> files[] = {{"cube.obj", asObj()},
                                                         {"ascii.ply", asPly(false)},
                                                         {"binary.PLY", asPly(true)},
                                                         {"ascii.stl", asStl(false)},
                                                         {"binary.stl", asStl(true)}};
    for (const auto& [name, bytes] : files) {
        INFO(name);
        REQUIRE(isSurfaceFile(name));
        const TriangleMesh mesh = readSurface(write(folder, name, bytes));
        CHECK(mesh.points.size() == 8);
        CHECK(mesh.triangles.size() == 12);
        CHECK(boundsOf(mesh) == openvdb::BBoxd(Vec3d(0), Vec3d(1)));
        const SurfaceCheck check = checkSurface(mesh);
        CHECK(check.problems() == "");
        REQUIRE(check.shells.size() == 1);
        CHECK(std::abs(check.shells[0].volume - 1.0) < 1e-12);
    }
    CHECK_FALSE(isSurfaceFile("cube.vdb"));
}

TEST_CASE("Files that hold no surface are refused by name") {
    const TempFolder folder;
    CHECK_THROWS_AS(readSurface(folder.file("missing.obj")), FileError);
    CHECK_THROWS_AS(readSurface(write(folder, "empty.stl", "")), FileError);
    CHECK_THROWS_AS(readSurface(write(folder, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), FileError);
    CHECK_THROWS_AS(readSurface(write(folder, "cut.ply", asPly(true).substr(0, 250))), FileError);
    std::string ply = asPly(false);
    const std::string element = "element vertex", type = "float x";
    CHECK_THROWS_AS(readSurface(write(folder, "property.ply", std::string(ply).erase(ply.find(element), 2))),
                    FileError);
    CHECK_THROWS_AS(readSurface(write(folder, "type.ply", ply.replace(ply.find(type), type.size(), "int x"))),
                    FileError);
    std::string bytes = asStl(true);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&bytes[80 + 4 + 12], &nan, sizeof nan);
    try {
        readSurface(write(folder, "nan.stl", bytes));
        FAIL("a point that is nowhere was read");
    } catch (const FileError& error) {
        CHECK(std::string(error.what()).find("nan.stl has a point") != std::string::npos);
    }
}

TEST_CASE("What keeps a surface from bounding a solid is counted") {
    SECTION("holes") {
        TriangleMesh open = kCube;
        open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2); // a side
        open.triangles.pop_back(); // half of another, beside it
        const SurfaceCheck check = checkSurface(open);
        CHECK(check.openEdges == 5);
        CHECK(check.holes == 1);
        CHECK(check.problems() == "1 hole (5 open edges)");
    }
    SECTION("edges of four triangles") {
        TriangleMesh twice = kCube;
        twice.triangles.insert(twice.triangles.end(), kCube.triangles.begin(), kCube.triangles.end());
        CHECK(checkSurface(twice).nonManifoldEdges == 18);
    }
    SECTION("a triangle that faces the other way") {
        TriangleMesh turned = kCube;
        std::swap(turned.triangles[0][0], turned.triangles[0][1]);
        CHECK(checkSurface(turned).misorientedEdges == 3);
    }
    SECTION("boxes that overlap, and others that touch") {
        TriangleMesh overlapping = kCube;
        addBox(overlapping, Vec3d(0.5, 0.25, 0.3), Vec3d(1.5, 0.7, 0.8));
        // The four sides of the second box, and those of the first one that they pass through.
        CHECK(checkSurface(overlapping).crossingTriangles == 10);
        TriangleMesh touching = kCube;
        addBox(touching, Vec3d(1, 0, 0), Vec3d(2, 1, 1));
        CHECK(checkSurface(touching).crossingTriangles == 0);
    }
}

TEST_CASE("A surface becomes a level set, and that a mesh of its volume") {
    const MeshFigures figures = meshed(kCube, 1.0 / 32);
    CHECK(figures.components == 1);
    CHECK(figures.euler == 2);
    CHECK(std::abs(figures.volume - 1.0) < 0.01);
}

TEST_CASE("Shells that face inwards are cavities inside others, and solid elsewhere") {
    TriangleMesh nested = kCube;
    addBox(nested, Vec3d(0.25), Vec3d(0.75), true);
    const MeshFigures hollow = meshed(nested, 1.0 / 32);
    CHECK(hollow.components == 2);
    CHECK(std::abs(hollow.volume - 0.875) < 0.02);

    const MeshFigures insideOut = meshed(box(Vec3d(0), Vec3d(1), true), 1.0 / 32);
    CHECK(std::abs(insideOut.volume - 1.0) < 0.01);

    TriangleMesh apart = kCube;
    addBox(apart, Vec3d(2), Vec3d(3), true);
    CHECK(std::abs(meshed(apart, 1.0 / 32).volume - 2.0) < 0.02);
}

TEST_CASE("A surface that encloses nothing is refused, and says why") {
    TriangleMesh open = kCube;
    open.triangles.resize(10);
    try {
        surfaceToVolume(open, checkSurface(open), 1.0 / 32);
        FAIL("an open box was taken for a solid");
    } catch (const NoSurface& error) {
        CHECK(std::string(error.what()).find("1 hole (4 open edges)") != std::string::npos);
    }
    CHECK_THROWS_AS(surfaceToVolume(kCube, checkSurface(kCube), 1e-6), BadOption);
    CHECK(defaultVoxel(kCube) == 1.0 / 256);
}

TEST_CASE("The level set of a surface is the same for any number of threads") {
    TriangleMesh surface = kCube;
    addBox(surface, Vec3d(0.5, 0.25, 0.3), Vec3d(1.5, 0.7, 0.8));
    std::vector<openvdb::FloatGrid::Ptr> grids;
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        grids.push_back(surfaceToVolume(surface, checkSurface(surface), 1.0 / 48));
    }
    for (const auto& grid : grids) {
        REQUIRE(grid->tree().hasSameTopology(grids[0]->tree()));
        for (auto value = grids[0]->cbeginValueOn(); value; ++value)
            REQUIRE(grid->tree().getValue(value.getCoord()) == *value);
    }
}
