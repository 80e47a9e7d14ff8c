/// @file BoundaryFaces.h
/// Counts the faces of exactly one tet.
#pragma once

#include "tets/TileTets.h"

namespace vdbtet {

/// @return the boundary faces of the tets that surface tile @a tile owns.
/// @details Three manifold vertices make a face that may lie on the boundary, any other vertex one that
/// cannot.
/// @param tets,states  of that tile
std::int64_t countBoundaryFaces(const Vertices& vertices, TileRef tile, const TileTets& tets,
                                const LocalStates& states);

} // namespace vdbtet
