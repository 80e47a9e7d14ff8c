/// @file BoundaryFaces.h
/// Finds the faces of exactly one tet.
#pragma once

#include "destinations/Changes.h"
#include "tets/TileTets.h"

#include <vector>

namespace vdbtet {

/// @brief Find the boundary faces of the tets that surface tile @a tile owns, as labels and flips say.
/// @details Three manifold vertices make a face that may lie on the boundary, any other vertex one that
/// cannot.
/// @param tets,states  of that tile
/// @param faces        receives them, in an order that depends on nothing else
void findBoundaryFaces(const Vertices& vertices, TileRef tile, const TileTets& tets,
                       const LocalStates& states, std::vector<LocalFace>& faces);

/// @brief Find those that the tile owns in the mesh as it is, and go to its tets in the mesh as it is.
/// @param tets  loaded, and not changed yet
void findChangedFaces(const Vertices& vertices, TileRef tile, TileTets& tets, const LocalStates& states,
                      std::vector<LocalFace>& faces);

} // namespace vdbtet
