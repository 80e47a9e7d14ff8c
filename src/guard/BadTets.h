/// @file BadTets.h
/// Finds the tets that the guard does not let pass.
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "flips/Flips.h"

#include <vector>

namespace vdbtet {

/// @return the manifold vertices of the bad tets that some tiles own: those in the mesh that have angles
/// beyond the guard's, or are inverted, of flipped octahedra then all six; and those dropped, as all four are
/// manifold. Some vertices come more than once, in the order of the tiles.
/// @param hasBad  by surface tile: receives, for the tiles looked at, whether they own a bad tet in the mesh
std::vector<VertexRef> verticesOfBadTets(const Vertices& vertices, const Flips& flips,
                                         const std::vector<TileRef>& tiles, std::vector<char>& hasBad,
                                         Interrupt& interrupt);

} // namespace vdbtet
