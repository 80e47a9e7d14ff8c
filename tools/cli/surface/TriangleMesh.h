/// @file TriangleMesh.h
/// A surface of triangles, and reading one from a file.
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <string>
#include <vector>

struct TriangleMesh {
    std::vector<openvdb::Vec3d> points;    ///< world space, no two equal
    std::vector<openvdb::Vec3I> triangles; ///< counter-clockwise from outside, three different points each
    std::int64_t degenerate = 0;           ///< triangles of the file with fewer, left out
};

/// @return whether the name is that of a file readSurface() reads, by its extension.
bool isSurfaceFile(const std::string& path);

/// @brief Read a surface; polygons are cut into fans of triangles, and points in the same place are one.
/// @param path  an .obj, .ply or .stl file, text or binary; its extension decides
/// @throw vdbtet::FileError when it cannot be read, holds no triangles, or has a point that is not finite
TriangleMesh readSurface(const std::string& path);

openvdb::BBoxd boundsOf(const TriangleMesh& mesh);
