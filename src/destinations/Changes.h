/// @file Changes.h
/// Where the mesh differs from what the labels and flips alone would give: tets that were put in or taken
/// out, and vertices that stand for several points. Few tiles have any.
#pragma once

#include "bits/TileMask.h"
#include "tiles/Layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// The local numbers of a face's vertices, counter-clockwise from outside.
using LocalFace = std::array<int, 3>;

/// A tet that a tile owns, by the kind and the lower end of the spine and its number in the octahedron.
using TetCode = std::uint16_t;
constexpr TetCode tetCode(int lattice, int axis, int number, int bit) {
    return TetCode(((lattice * 3 + axis) * 4 + number) << 9 | bit);
}

constexpr int tetBit(TetCode code) { return code & 511; }
constexpr int tetNumber(TetCode code) { return code >> 9 & 3; }
constexpr int tetAxis(TetCode code) { return (code >> 11) % 3; }
constexpr int tetLattice(TetCode code) { return (code >> 11) / 3; }

/// What differs in one tile. Local numbers are as this tile sees them.
struct TileChanges {
    /// Own tets that are in the mesh though ambiguous, or not though they are not; ascending.
    std::vector<TetCode> tets;

    /// Own boundary faces less, and more.
    std::vector<LocalFace> gone, fresh;

    /// Own vertices, by lattice: in the mesh now, or no longer; on the boundary though not manifold, or
    /// inside though manifold.
    std::array<TileMask, 2> used, unused, exposed, buried;

    /// Own vertices, as lattice << 9 | bit, once for each point more than one; ascending.
    std::vector<std::uint16_t> copies;

    /// A corner that is a copy of a vertex, not the vertex's first point.
    struct Copy {
        int vertex; ///< the local number
        int number; ///< in copies of the tile that owns the vertex
    };
    struct TetCopy {
        TetCode tet;
        Copy copy;
    };
    struct FaceCopy {
        LocalFace face; ///< ascending
        Copy copy;
    };
    std::vector<TetCopy> tetCopies;   ///< of own tets; ascending
    std::vector<FaceCopy> faceCopies; ///< of own boundary faces; ascending
};

struct Changes {
    std::vector<std::int32_t> numbers; ///< of each surface tile: where its changes are, or -1
    std::vector<TileChanges> tiles;

    /// @return the changes of a tile, or null
    const TileChanges* of(TileRef tile) const {
        return tile < 0 || numbers[tile] < 0 ? nullptr : &tiles[numbers[tile]];
    }

    /// @return some vertices, and those on the boundary though not manifold.
    VertexMasks withExposed(VertexMasks masks) const {
        for (std::size_t t = 0; t < masks.size(); ++t) {
            if (numbers[t] < 0) continue;
            for (std::size_t lattice = 0; lattice < 2; ++lattice)
                masks[t][lattice] |= tiles[std::size_t(numbers[t])].exposed[lattice];
        }
        return masks;
    }
};

} // namespace vdbtet
