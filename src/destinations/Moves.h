/// @file Moves.h
/// Where vertices are that a later stage has moved on from their destinations.
#pragma once

#include "bits/TileMask.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// The offsets of vertices from their places in the lattice.
struct Moves {
    std::vector<std::array<TileMask, 2>> moved; ///< of each surface tile: the vertices that have an offset
    std::vector<std::array<std::int64_t, 2>> first; ///< of a tile and lattice; the offsets go by bit
    std::vector<openvdb::Vec3f> offsets;            ///< lattice units
};

} // namespace vdbtet
