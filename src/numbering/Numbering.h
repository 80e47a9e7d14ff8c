/// @file Numbering.h
/// Which vertices are in the mesh, and their ids.
#pragma once

#include "destinations/LocalVertices.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Point ids: those of a span start at first[span]; within a tile they go by rank in the used masks,
/// L_A before L_B.
struct Numbering {
    /// The used vertices of each surface tile. Interior tiles use all of theirs.
    std::vector<std::array<TileMask, 2>> used;

    /// The first id of each span of the layout, and the number of all points at the end.
    std::vector<std::int64_t> first;

    std::int64_t points() const { return first.back(); }
};

/// The points of an interior tile.
constexpr std::int64_t kInteriorPoints = 2 * TileMask::kSize;

/// @details Every vertex inside is used. A manifold vertex is used iff one of its 14 lattice neighbours is
/// inside and not manifold: the edge to that neighbour is in the mesh, or, flipped, another such edge of the
/// same octahedron.
Numbering numberVertices(const Vertices& vertices, Interrupt& interrupt);

} // namespace vdbtet
