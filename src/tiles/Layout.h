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

    /// The tiles of equal x and y.
    struct Column {
        int x, y;
        std::int64_t begin, end; ///< its spans
    };

    std::vector<Span> spans;
    std::vector<Column> columns;
    std::vector<openvdb::Coord> surfaceTiles; ///< ascending

    std::int64_t surfaceCount() const { return std::int64_t(surfaceTiles.size()); }

    /// The spans that hold a tile and its neighbours, by neighbourSlot(); -1 for tiles outside.
    std::array<std::int64_t, 27> spansAround(const openvdb::Coord& tile) const;

    std::vector<Neighbours> neighbours; ///< of each surface tile
};

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
