/// @file BoundaryCheck.h
/// Where the boundary of the mesh is not a surface.
#pragma once

#include "Parallel.h"
#include "destinations/LocalVertices.h"
#include "flips/Flips.h"

#include <cstdint>
#include <vector>

namespace vdbtet {

/// A vertex of a surface tile, in a number that sorts by tile, then lattice, then bit.
struct VertexId {
    static constexpr std::int64_t of(TileRef tile, int lattice, int bit) {
        return (std::int64_t(tile) << 1 | lattice) << 9 | bit;
    }
    static constexpr TileRef tile(std::int64_t id) { return TileRef(id >> 10); }
    static constexpr bcc::Lattice lattice(std::int64_t id) { return bcc::Lattice(id >> 9 & 1); }
    static constexpr int bit(std::int64_t id) { return int(id & 511); }
    /// Seen from its tile.
    static constexpr int local(std::int64_t id) { return localIndex(lattice(id), bit(id)); }
};

/// @brief Find the vertices whose boundary triangles are not one closed fan, in ascending order.
/// @details At any other vertex the mesh is as good as a ball cut in half. Edges of the boundary with more
/// than two triangles show at both their ends.
std::vector<std::int64_t> findPinched(const Vertices& vertices, const Flips& flips, Interrupt& interrupt);

} // namespace vdbtet
