/// @file Boundary.h
/// The surface of a mesh, for tests that compare surfaces.
#pragma once

#include <vdbtet/TetMesh.h>

#include <array>
#include <vector>

namespace vdbtet::test {

/// A triangle by the coordinates of its corners, the least corner first, seen from outside.
using Triangle = std::array<std::array<double, 3>, 3>;

/// The faces of exactly one tet, in ascending order: equal for meshes with the same surface, bit for bit,
/// however their points and tets are numbered.
std::vector<Triangle> boundaryOf(const TetMesh& mesh);

} // namespace vdbtet::test
