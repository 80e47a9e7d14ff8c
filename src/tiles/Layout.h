/// @file Layout.h
/// Which tiles the mesh touches, in which order, and who is whose neighbour.
#pragma once

#include "Parallel.h"
#include "bits/TileMask.h"
#include "field/Field.h"
#include "tiles/Spans.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// The 27 tiles around and including a tile, by neighbourSlot().
using Neighbours = std::array<TileRef, 27>;

/// Vertices of each surface tile, by lattice.
using VertexMasks = std::vector<std::array<TileMask, 2>>;

/// @brief The tiles that take part, as runs along z in ascending order: single surface tiles, and runs of
/// interior tiles.
/// @details A bounded inside ends at the surface in every direction, so what lies between two surface tiles
/// of a column is told by a sign of the lower one. Interior tiles need no other record, and memory grows with
/// the surface alone.
struct Layout {
    Spans spans;                              ///< of surface tiles, by index, and of interior tiles
    std::vector<openvdb::Coord> surfaceTiles; ///< ascending
    std::vector<Neighbours> neighbours;       ///< of each surface tile but the borrowed ones
    /// In a part of a mesh: how many of the surface tiles, the last ones, are another part's. Stages read
    /// their records, and make none for them.
    std::int64_t borrowed = 0;

    std::int64_t surfaceCount() const { return std::int64_t(surfaceTiles.size()); }
    std::int64_t ownCount() const { return surfaceCount() - borrowed; }
    /// Of a surface tile: L_A's lowest vertex, in units of the lattice.
    openvdb::Vec3d origin(TileRef tile) const { return 8.0 * surfaceTiles[std::size_t(tile)].asVec3d(); }
};

/// Whether the lowest and the highest vertex of a tile, of those with x and y of 0, are inside.
struct TileEnds {
    bool lowest, highest;

    static TileEnds of(const TileSigns& signs) {
        return {signs[bcc::A].test(TileMask::bit(0, 0, 0)), signs[bcc::A].test(TileMask::bit(0, 0, 7))};
    }
};

/// @brief Find the runs of interior tiles between surface tiles.
/// @param surfaceTiles  ascending
/// @param ends          of each
/// @return the spans of both; a surface tile's record is its index
/// @throw UnboundedInside where a column of tiles starts or ends inside
Spans makeSpans(const std::vector<openvdb::Coord>& surfaceTiles, const std::vector<TileEnds>& ends);

/// @brief Lay out the tiles.
/// @param surfaceTiles  as Field::surfaceTiles() gives them
/// @param signs         of each surface tile
/// @throw UnboundedInside where a column of tiles starts or ends inside
Layout makeLayout(std::vector<openvdb::Coord> surfaceTiles, const std::vector<TileSigns>& signs,
                  Interrupt& interrupt);

/// Gathers the masks of a tile and its neighbours, which must outlive it.
class Surroundings {
public:
    explicit Surroundings(const Neighbours& neighbours) : mNeighbours(neighbours) {}

    /// The inside vertices.
    MasksAround signs(const std::vector<TileSigns>& signs, int lattice) const {
        return gather(signs, lattice, kFull);
    }

    /// A mask that is empty away from the surface.
    template <typename Masks>
    MasksAround masks(const std::vector<Masks>& masks, int lattice) const {
        return gather(masks, lattice, kEmpty);
    }

private:
    static inline const TileMask kEmpty = TileMask::filled(false);
    static inline const TileMask kFull = TileMask::filled(true);

    template <typename Masks>
    MasksAround gather(const std::vector<Masks>& masks, int lattice, const TileMask& interior) const {
        MasksAround around;
        for (int slot = 0; slot < 27; ++slot) {
            const TileRef tile = mNeighbours[slot];
            around.masks[slot] = tile >= 0 ? &masks[tile][lattice] : tile == kInside ? &interior : &kEmpty;
        }
        return around;
    }

    const Neighbours& mNeighbours;
};

} // namespace vdbtet
