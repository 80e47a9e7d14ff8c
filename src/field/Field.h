/// @file Field.h
/// The scalar field as the lattice sees it: where its surface may be, its signs, and its cut points.
///
/// The field phi is positive inside, as in the paper; phi >= 0 counts as inside (equation (2)). This
/// interface is where the types of grids end: all later stages are plain code.
#pragma once

#include "bcc/Lattice.h"
#include "bits/TileMask.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbtet {

/// The inside vertices of a tile, L_A and L_B.
using TileSigns = std::array<TileMask, 2>;

class Field {
public:
    virtual ~Field() = default;

    /// How far, in lattice units, a tile outside surfaceTiles() is from the surface at least: neither its
    /// vertices nor their neighbours touch a cut edge, so all of them are plain inside or plain outside.
    static constexpr double kClearance = 2.0;

    /// @return the tiles that the surface comes within kClearance of, in ascending order. Tile (x,y,z) owns
    /// the vertices [8x, 8x+8) x [8y, 8y+8) x [8z, 8z+8) of both lattices.
    /// @throw TooLarge for more than @a maxTiles
    virtual std::vector<openvdb::Coord> surfaceTiles(std::int64_t maxTiles) const = 0;

    /// Reads the field; one for each task, since it caches.
    class Sampler {
    public:
        virtual ~Sampler() = default;

        virtual TileSigns signs(const openvdb::Coord& tile) = 0;

        /// @brief Find the cut points of short edges.
        /// @param cut  for each direction the L_A vertices of @a tile whose short edge that way has ends of
        /// opposite sign
        /// @param t    receives for each of them, by direction and then by bit, the cut point's distance from
        /// the L_A end as a fraction of the edge, in [0, 1]
        virtual void cutPoints(const openvdb::Coord& tile, const std::array<TileMask, bcc::kDirections>& cut,
                               float* t) = 0;
    };

    virtual std::unique_ptr<Sampler> sampler() const = 0;
};

} // namespace vdbtet
