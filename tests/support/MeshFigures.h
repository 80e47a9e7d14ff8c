/// @file MeshFigures.h
/// The one judge of tetrahedral meshes: it knows nothing of how they were made.
#pragma once

#include <vdbtet/TetMesh.h>

#include <array>
#include <cstdint>

namespace vdbtet::test {

/// What a mesh is; every figure but the first three and the last ones is 0 for a good one.
struct MeshFigures {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::int64_t triangles = 0; ///< faces of exactly one tet: the boundary

    std::int64_t badIndices = 0;      ///< out of range, or twice in a tet; then nothing else is computed
    std::int64_t nonFinitePoints = 0; ///< the same
    std::int64_t inverted = 0;        ///< tets of volume <= 0
    std::int64_t overusedFaces = 0;   ///< faces of three or more tets
    std::int64_t misorientedFaces = 0;
    std::int64_t unusedPoints = 0;
    std::int64_t duplicatePoints = 0;
    std::int64_t nonmanifoldEdges = 0;  ///< boundary edges that are not in exactly two boundary triangles
    std::int64_t nonmanifoldPoints = 0; ///< boundary points whose triangles are not one closed fan

    std::int64_t components = 0; ///< of the boundary, joined by edges
    std::int64_t euler = 0;      ///< of the boundary, V - E + F
    double volume = 0;
    double minAngle = 180; ///< dihedral, degrees
    double maxAngle = 0;
    /// How far the rounding of its coordinates may turn an angle, degrees.
    double precision = 0;
    /// Angles below 10 i degrees by that much at least, and at most: a lattice tet has angles of exactly 60
    /// and 90 degrees, which rounding puts on either side.
    std::array<std::int64_t, 18> surelyBelow{}, maybeBelow{};
};

MeshFigures examine(const TetMesh& mesh);

/// The six dihedral angles of a tet in degrees, from the sines and cosines at its edges.
std::array<double, 6> angleOfEdges(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                                   const openvdb::Vec3d& d);

} // namespace vdbtet::test
