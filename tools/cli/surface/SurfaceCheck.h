/// @file SurfaceCheck.h
/// Whether a surface of triangles bounds a solid.
#pragma once

#include "TriangleMesh.h"

#include <cstdint>
#include <string>
#include <vector>

/// A part of the surface that hangs together.
struct Shell {
    std::vector<openvdb::Vec3I> triangles;
    double volume = 0.0; ///< signed: negative where the triangles face inwards, as those of a cavity do
};

struct SurfaceCheck {
    std::vector<Shell> shells;          ///< by their lowest point
    std::int64_t openEdges = 0;         ///< edges of one triangle
    std::int64_t holes = 0;             ///< groups of open edges that hang together
    std::int64_t nonManifoldEdges = 0;  ///< edges of more than two triangles
    std::int64_t misorientedEdges = 0;  ///< edges of two triangles, one of which faces the other way
    std::int64_t crossingTriangles = 0; ///< triangles that pass through others

    bool closed() const { return openEdges == 0; }
    /// @return what is wrong, in words; empty if nothing is.
    std::string problems() const;
};

SurfaceCheck checkSurface(const TriangleMesh& mesh);

/// @return how many triangles an edge of another one passes through, or whose edges pass through another one;
/// those that merely touch, or lie in the same plane, do not count.
std::int64_t countCrossing(const TriangleMesh& mesh);
