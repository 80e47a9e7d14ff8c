/// @file TriangleMesh.cc
/// Reads surfaces with CGAL.
#include "TriangleMesh.h"

#include <vdbtet/Errors.h>

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include <tbb/parallel_sort.h>

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>

namespace {

using vdbtet::FileError;

std::string lowerExtension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void requireRegularFile(const std::string& path) {
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0)
        throw FileError("cannot read " + path + ": " + std::strerror(errno));
    if (!S_ISREG(info.st_mode)) throw FileError("cannot read " + path + ": it is not a regular file");
}

/// CGAL 5 follows a null pointer where a property belongs to no element.
void requirePlyHeader(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    for (std::string line, word; std::getline(stream, line);) {
        std::istringstream(line) >> word;
        if (word == "element") return;
        if (word == "property") throw FileError(path + " is damaged: a property of no element");
    }
}

/// In place of CGAL's own, which prints; the exception is thrown all the same.
void saysNothing(const char*, const char*, const char*, int, const char*) {}

/// What the file holds, as it is.
TriangleMesh import(const std::string& path) {
    using Point = CGAL::Simple_cartesian<double>::Point_3;
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> polygons;
    if (lowerExtension(path) == ".ply") requirePlyHeader(path);
    CGAL::set_error_handler(saysNothing);
    bool whole = false;
    try {
        whole = CGAL::IO::read_polygon_soup(path, points, polygons, CGAL::parameters::verbose(false));
    } catch (const CGAL::Failure_exception&) {
        whole = false;
    }
    if (!whole) throw FileError(path + " is truncated or damaged, or not what its extension says");
    if (points.size() > std::numeric_limits<openvdb::Index32>::max())
        throw FileError(path + " has more than 2^32 points, which OpenVDB cannot number");
    TriangleMesh mesh;
    for (const Point& p : points) {
        if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
            throw FileError(path + " has a point whose coordinates are NaN or infinite");
        mesh.points.emplace_back(p.x(), p.y(), p.z());
    }
    for (const auto& polygon : polygons) {
        for (const std::size_t corner : polygon) {
            if (corner >= points.size())
                throw FileError(path + " is damaged: a polygon has a point that is not there");
        }
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            mesh.triangles.emplace_back(openvdb::Index32(polygon[0]), openvdb::Index32(polygon[k - 1]),
                                        openvdb::Index32(polygon[k]));
        }
    }
    return mesh;
}

/// Make points in the same place one, and drop the triangles that are none.
TriangleMesh weld(const TriangleMesh& soup) {
    std::vector<openvdb::Index32> order(soup.points.size()), idOf(soup.points.size());
    std::iota(order.begin(), order.end(), 0);
    tbb::parallel_sort(order.begin(), order.end(), [&](openvdb::Index32 a, openvdb::Index32 b) {
        return soup.points[a] != soup.points[b] ? soup.points[a] < soup.points[b] : a < b;
    });
    TriangleMesh mesh;
    for (const openvdb::Index32 v : order) {
        if (mesh.points.empty() || mesh.points.back() != soup.points[v])
            mesh.points.push_back(soup.points[v]);
        idOf[v] = openvdb::Index32(mesh.points.size() - 1);
    }
    for (const openvdb::Vec3I& t : soup.triangles) {
        const openvdb::Vec3I welded(idOf[t[0]], idOf[t[1]], idOf[t[2]]);
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) {
            ++mesh.degenerate;
        } else {
            mesh.triangles.push_back(welded);
        }
    }
    return mesh;
}

} // namespace

bool isSurfaceFile(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".obj" || extension == ".ply" || extension == ".stl";
}

TriangleMesh readSurface(const std::string& path) {
    requireRegularFile(path);
    TriangleMesh mesh = weld(import(path));
    if (mesh.triangles.empty()) throw FileError(path + " holds no triangles");
    return mesh;
}

openvdb::BBoxd boundsOf(const TriangleMesh& mesh) {
    openvdb::BBoxd bounds;
    for (const openvdb::Vec3d& p : mesh.points) bounds.expand(p);
    return bounds;
}
