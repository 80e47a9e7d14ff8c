/// @file MeshMatch.h
/// Tells whether two meshes are the same one, however their points and tets are numbered.
#pragma once

#include <vdbtet/TetMesh.h>

#include <string>

namespace vdbtet::test {

struct MeshMatch {
    bool same = false;
    std::string difference; ///< what differs first, in words
    double farthest = 0;    ///< the greatest distance between two points taken for one
};

/// @param tolerance  points this near each other are taken for one; must be far less than any edge's length
MeshMatch matchMeshes(const TetMesh& a, const TetMesh& b, double tolerance);

/// Fails the running test where the two differ.
void requireSame(const TetMesh& a, const TetMesh& b, double tolerance);

/// Fails the running test where two meshes differ in a single bit.
void requireIdentical(const TetMesh& a, const TetMesh& b);

} // namespace vdbtet::test
