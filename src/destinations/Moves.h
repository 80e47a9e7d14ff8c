/// @file Moves.h
/// Where vertices are that a later stage has moved on from their destinations.
#pragma once

#include "bits/TileMask.h"
#include "tiles/Spans.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// The offsets of vertices from their places in the lattice.
struct Moves {
    std::vector<std::array<TileMask, 2>> moved; ///< of each surface tile: the vertices that have an offset
    std::vector<std::array<std::int64_t, 2>>
        first; ///< the first offset of a tile and lattice, and the end; they go by bit of moved
    std::vector<openvdb::Vec3f> offsets; ///< lattice units

    /// @return whether a surface tile has any vertex that is not at home.
    bool any(TileRef tile) const { return first[tile][0] != first[tile + 1][0]; }

    /// Number the offsets of the vertices in moved.
    /// @return how many there are
    std::int64_t number();
};

} // namespace vdbtet
