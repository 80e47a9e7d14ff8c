/// @file Closure.h
/// Which octants must exist so that no face or edge is finer on one side than balance allows.
#pragma once

#include "bits/TileMask.h"

#include <array>
#include <cstdint>

namespace vdbtet {

/// The octants of a tile, which is 8 units an edge, by level: those of level l are 2^l units an edge. Those
/// of level 0 are a mask of their own; the only one of level 3 is the tile.
struct OctantSet {
    std::uint64_t level1 = 0; ///< bit x<<4 | y<<2 | z
    std::uint8_t level2 = 0;  ///< bit x<<2 | y<<1 | z
    bool level3 = false;

    bool test1(int x, int y, int z) const { return level1 >> (x << 4 | y << 2 | z) & 1; }
    bool test2(int x, int y, int z) const { return level2 >> (x << 2 | y << 1 | z) & 1; }
};

/// @brief Close a tile's octants under weak balance: for every octant that exists the parents of itself and
/// of its 18 face and edge neighbours do.
/// @param units  the octants of level 0 of the tile and its neighbours, by neighbourSlot(); null for none
/// @details Without the edges nodes would hang; corners need no balance. What a tile gets depends on no unit
/// beyond its neighbours.
OctantSet closeOctants(const std::array<const TileMask*, 27>& units);

} // namespace vdbtet
