/// @file BoundaryFaces.h
/// Finds the faces of exactly one tet.
#pragma once

#include "tets/TileTets.h"

#include <array>
#include <vector>

namespace vdbtet {

/// The local numbers of a face's vertices, counter-clockwise from outside.
using LocalFace = std::array<int, 3>;

/// @brief Find the boundary faces of the tets that surface tile @a tile owns.
/// @details Three manifold vertices make a face that may lie on the boundary, any other vertex one that
/// cannot.
/// @param tets,states  of that tile
/// @param faces        receives them, in an order that depends on nothing else
void findBoundaryFaces(const Vertices& vertices, TileRef tile, const TileTets& tets,
                       const LocalStates& states, std::vector<LocalFace>& faces);

} // namespace vdbtet
