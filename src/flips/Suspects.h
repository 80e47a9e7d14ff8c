/// @file Suspects.h
/// Where the boundary of the mesh may be no surface, as far as the states of the vertices tell.
#pragma once

#include "Parallel.h"
#include "destinations/LocalVertices.h"
#include "simd/Isa.h"

#include <array>
#include <vector>

namespace vdbtet {

/// Some vertices of a surface tile, by lattice.
struct Suspects {
    TileRef tile;
    std::array<TileMask, 2> vertices;
};

/// @brief Find the manifold vertices of a tile whose boundary triangles the states alone do not prove to be
/// one closed fan, or none.
/// @param states  of the tile and its border
/// @details The 14 neighbours of a vertex are the vertices of its link, a triangulated sphere. Its tets in
/// the mesh are the triangles there that touch a vertex inside and none outside. They make a disc, all of the
/// sphere, or nothing, if those inside are connected by edges of the link, those outside are, too, and no
/// triangle has three manifold vertices: then no edge, and so no triangle, is both next to the one and the
/// other, and what is between them is a single closed curve.
///
/// Flips change nothing about that. An edge of the link from inside to outside is a spine that is flipped,
/// with a ring of manifold vertices, and the curve crosses it. Any other flipped octahedron has all its tets
/// in the mesh before and after, be it chosen for quality or by Algorithm 5: one end of its spine is inside,
/// so that none of its ring is outside, and two of the ring, of which each tet has one, are inside unless
/// there is a conflict. What the last resort does to conflicts is beyond this.
std::array<TileMask, 2> findSuspects(const LocalStates& states, Isa isa = bestIsa());

/// @return those of all own surface tiles that have any, ascending.
std::vector<Suspects> findSuspects(const Vertices& vertices, Interrupt& interrupt);

} // namespace vdbtet
