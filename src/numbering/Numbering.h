/// @file Numbering.h
/// Which vertices are in the mesh, and the ids of points and tets: the exact size of the mesh, before any of
/// it is made.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "destinations/LocalVertices.h"
#include "flips/Flips.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Ids: those of a span's points start at firstPoint[span]; within a tile they go by rank in the used
/// masks, L_A before L_B. Those of its tets start at firstTet[span] and go in the order of TileTets.
struct Numbering {
    /// The used vertices of each surface tile. Interior tiles use all of theirs.
    std::vector<std::array<TileMask, 2>> used;

    /// By span of the layout, and the number of all at the end.
    std::vector<std::int64_t> firstPoint, firstTet;

    std::int64_t points() const { return firstPoint.back(); }
    std::int64_t tets() const { return firstTet.back(); }

    std::int64_t ambiguous = 0; ///< tets of four manifold vertices, which are not in the mesh
    openvdb::BBoxd bounds;      ///< of the used points, world space
};

/// The points of an interior tile.
constexpr std::int64_t kInteriorPoints = 2 * TileMask::kSize;

/// @details Every vertex inside is used. A manifold vertex is used iff one of its 14 lattice neighbours is
/// inside and not manifold: the edge to that neighbour is in the mesh, or, flipped, another such edge of the
/// same octahedron.
Numbering numberMesh(const Vertices& vertices, const Flips& flips, const Frame& frame, Interrupt& interrupt);

} // namespace vdbtet
