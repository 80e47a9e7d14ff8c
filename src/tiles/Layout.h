/// @file Layout.h
/// Which tiles the mesh touches, in which order, and who is whose neighbour.
#pragma once

#include "Parallel.h"
#include "bits/TileMask.h"
#include "field/Field.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// A tile as its neighbours see it: the index of a surface tile, or one of the two constants below.
using TileRef = std::int32_t;
constexpr TileRef kInside = -1;  ///< all vertices inside and far from any cut edge
constexpr TileRef kOutside = -2; ///< all vertices outside and far from any cut edge

/// The 27 tiles around and including a tile, by neighbourSlot().
using Neighbours = std::array<TileRef, 27>;

/// @brief The tiles that take part, as runs along z in ascending order: single surface tiles, and runs of
/// interior tiles.
/// @details A bounded inside ends at the surface in every direction, so what lies between two surface tiles
/// of a column is told by a sign of the lower one. Interior tiles need no other record, and memory grows with
/// the surface alone.
struct Layout {
    struct Span {
        openvdb::Coord first;      ///< the lowest tile
        std::int64_t count = 1;    ///< tiles along z
        TileRef surface = kInside; ///< the index of the surface tile, or kInside for a run of interior tiles
    };

    std::vector<Span> spans;
    std::vector<openvdb::Coord> surfaceTiles; ///< ascending
    std::vector<std::int64_t> surfaceSpans;   ///< the span of each surface tile
    std::vector<Neighbours> neighbours;       ///< of each surface tile

    /// @return the span that holds @a tile, or -1 for a tile outside.
    std::int64_t find(const openvdb::Coord& tile) const;

    /// The tiles of equal x and y.
    struct Column {
        int x, y;
        std::int64_t begin, end; ///< its spans
    };
    std::vector<Column> columns;
};

/// @brief Lay out the tiles.
/// @param surfaceTiles  as Field::surfaceTiles() gives them
/// @param signs         of each surface tile
/// @throw UnboundedInside where a column of tiles starts or ends inside
Layout makeLayout(std::vector<openvdb::Coord> surfaceTiles, const std::vector<TileSigns>& signs,
                  Interrupt& interrupt);

/// Gathers the masks of a tile and its neighbours.
class Surroundings {
public:
    explicit Surroundings(const Neighbours& neighbours) : mNeighbours(neighbours) {}

    /// The inside vertices.
    PaddedMask signs(const std::vector<TileSigns>& signs, int lattice) const {
        return gather(signs, lattice, mFull);
    }

    /// A mask that is empty away from the surface.
    template <typename Masks>
    PaddedMask masks(const std::vector<Masks>& masks, int lattice) const {
        return gather(masks, lattice, mEmpty);
    }

private:
    template <typename Masks>
    PaddedMask gather(const std::vector<Masks>& masks, int lattice, const TileMask& interior) const {
        std::array<const TileMask*, 27> all;
        for (int slot = 0; slot < 27; ++slot) {
            const TileRef tile = mNeighbours[slot];
            all[slot] = tile >= 0 ? &masks[tile][lattice] : tile == kInside ? &interior : &mEmpty;
        }
        return PaddedMask(all);
    }

    const Neighbours& mNeighbours;
    TileMask mEmpty = TileMask::filled(false);
    TileMask mFull = TileMask::filled(true);
};

} // namespace vdbtet
