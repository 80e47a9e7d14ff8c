/// @file Boundary.h
/// The surface of a mesh, for tests that compare surfaces.
#pragma once

#include <vdbtet/TetMesh.h>

#include <array>
#include <vector>

namespace vdbtet::test {

/// The corners of a triangle, counter-clockwise from outside, the least first.
using Corners = std::array<std::array<double, 3>, 3>;

/// The same of triangles of a mesh, in ascending order.
std::vector<Corners> cornersOf(const TetMesh& mesh, const std::vector<Triangle>& triangles);

/// The faces of exactly one tet, in ascending order: equal for meshes with the same surface, bit for bit,
/// however their points and tets are numbered.
std::vector<Corners> boundaryOf(const TetMesh& mesh);

} // namespace vdbtet::test
