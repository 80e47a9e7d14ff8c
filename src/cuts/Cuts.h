/// @file Cuts.h
/// The cut short edges and their cut points (paper, section 2.3).
#pragma once

#include "Parallel.h"
#include "field/Field.h"
#include "tiles/Layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// For each direction the vertices of a tile that have some property along the short edge that way.
using EdgeMasks = std::array<TileMask, bcc::kDirections>;

/// @brief The cut short edges of every surface tile.
/// @details An edge belongs to the tile of its L_A end. One cut point is stored an edge, so both ends see the
/// same point. An *arrow* runs along each from its near end to its far end; on a tie from the L_A end.
struct Cuts {
    std::vector<EdgeMasks> cut; ///< L_A vertices with a cut edge in each direction

    /// arrows[tile][lattice]: the vertices of that lattice from which an arrow leaves in each direction.
    std::vector<std::array<EdgeMasks, 2>> arrows;

    /// @return the cut point's distance from the L_A end, as a fraction of the edge, in [0, 1].
    /// @param vertex  an L_A vertex of @a tile whose edge in @a direction is cut
    float t(TileRef tile, int vertex, int direction) const {
        return fractions[first[tile][direction] + cut[tile][direction].rank(vertex)];
    }

    std::int64_t count() const { return std::int64_t(fractions.size()); }

    std::vector<std::array<std::int64_t, bcc::kDirections>> first; ///< into fractions, by tile and direction
    std::vector<float> fractions;
};

/// @return the signs of @a tiles.
std::vector<TileSigns> findSigns(const Field& field, const std::vector<openvdb::Coord>& tiles,
                                 Interrupt& interrupt);

Cuts findCuts(const Field& field, const Layout& layout, const std::vector<TileSigns>& signs,
              Interrupt& interrupt);

} // namespace vdbtet
