/// @file SplitFans.h
/// Makes a closed surface of triangles a manifold by giving each fan of them its own point.
#pragma once

#include <vdbtet/MeshSink.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Split points at which triangles are not one closed fan, until two triangles meet at each edge.
/// @param points     the copies are added at the end, the splitting of lower points first
/// @param triangles  numbers of points, counter-clockwise from outside; as many go along each edge one way
/// as the other. Corners in any fan but that of a point's first triangle become the copies.
/// @return how many points were added
/// @details At an edge of more than two triangles those are neighbours that are two sides of one wedge of the
/// solid: so parts that merely touch come apart. Where that leaves two wedges in one fan at both ends of the
/// edge, as in a ring of tets that touches itself, two of their triangles swap their neighbours, which splits
/// that fan at both ends. No triangle moves or is added.
std::int64_t splitFans(std::vector<openvdb::Vec3d>& points, std::vector<Triangle>& triangles);

} // namespace vdbtet
