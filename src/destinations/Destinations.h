/// @file Destinations.h
/// Where the manifold vertices move to (paper, section 4.2 and step 5 of Algorithm 1).
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief The moves of the manifold vertices from their places in the lattice.
/// @details Later stages read nothing but move(); Algorithm 5 alone asks for directions and distances, too.
struct Destinations {
    std::vector<std::array<std::int64_t, 2>>
        first; ///< the first move of a tile and lattice, and the end; they go by bit of Labels::manifold
    std::vector<std::array<std::array<std::uint16_t, TileMask::kDim>, 2>>
        before;                   ///< how many of them there are before each word of that mask
    std::vector<float> distances; ///< as fractions of a short edge
    std::vector<std::uint8_t> directions;

    /// Make room for a move of each vertex in Labels::manifold.
    void numberMoves(const std::vector<std::array<TileMask, 2>>& manifold);

    /// @return whether a surface tile has any manifold vertex.
    bool any(TileRef tile) const { return first[tile][bcc::A] != first[tile + 1][bcc::A]; }

    /// @return move number @a i, in lattice units.
    openvdb::Vec3d move(std::int64_t i) const {
        const double distance = distances[i];
        const auto& edge = bcc::kShortEdges[directions[i]];
        return openvdb::Vec3d(distance * edge[0], distance * edge[1], distance * edge[2]);
    }
};

/// Each manifold vertex moves to its nearest cut point on an edge to a non-manifold vertex, at most half the
/// edge; of equally near ones the lowest direction wins.
Destinations findDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                              const Labels& labels, Interrupt& interrupt);

} // namespace vdbtet
