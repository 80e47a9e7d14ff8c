/// @file Flips.h
/// Which octahedra are cut along a diagonal of their ring instead of their spine (paper, sections 4.4
/// and 6.2).
#pragma once

#include "Parallel.h"
#include "bcc/Lattice.h"
#include "destinations/LocalVertices.h"
#include "flips/Suspects.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdbtet {

/// A flipped spine of a tile.
struct Flip {
    bcc::Lattice lattice;
    int axis;
    bcc::Slice slice; ///< A or B
    int vertex;       ///< the bit of the spine's lower end
};

/// The flips of all surface tiles; most tiles have few.
struct Flips {
    std::vector<std::int64_t> first; ///< of each surface tile, and their number at the end
    std::vector<std::uint16_t> codes;

    static std::uint16_t encode(const Flip& f) {
        return std::uint16_t(((f.lattice * 3 + f.axis) * 2 + (f.slice - bcc::SliceA)) << 9 | f.vertex);
    }
    static Flip decode(std::uint16_t code) {
        const int kind = code >> 9;
        return {bcc::Lattice(kind / 6), kind / 2 % 3, bcc::Slice(bcc::SliceA + kind % 2), code & 511};
    }

    /// Call @a visit(Flip) for each flip of a surface tile, by lattice, then axis, then slice, then bit.
    template <typename Visit>
    void forEach(TileRef tile, Visit&& visit) const {
        for (std::int64_t i = first[tile]; i < first[tile + 1]; ++i) visit(decode(codes[i]));
    }

    std::int64_t active = 0;     ///< flipped by Algorithm 4
    std::int64_t extra = 0;      ///< flipped by Algorithm 5
    std::int64_t quality = 0;    ///< flipped for the better angles alone, in version 3
    std::int64_t lastResort = 0; ///< of the conflicts, those flipped
    std::int64_t conflicts = 0;  ///< octahedra of Algorithm 5 with another manifold vertex
    /// The centres of the first Places::kMost conflicts, in units of the lattice.
    std::vector<openvdb::Vec3d> conflictPlaces;

    /// findSuspects() of all own tiles, where that was done while the states were at hand.
    std::optional<std::vector<Suspects>> suspects;
};

/// @brief Choose all flips of versions 1 and 2.
/// @param version  1 for Algorithm 4 alone, 2 for Algorithm 5 too
/// @details No two flipped octahedra share a tet (Propositions 5 to 7), so each is chosen alone.
Flips chooseFlips(const Vertices& vertices, int version, Interrupt& interrupt);

constexpr double kExtremeMove = 0.3; ///< of a short edge; Algorithm 5

/// What Algorithm 5 finds in one octahedron.
struct ExtraFlip {
    bool matches = false;  ///< the directions and lengths of Figure 10, v1 being inside
    bool conflict = false; ///< and a further vertex is manifold
    bcc::Slice slice = bcc::S;
};

/// @brief Algorithm 5 with the last resort of section 6.2.2.
/// @details The slice is the one whose new edge ends where v2 moves away from: A in case 1, B in case 2 of
/// Figure 10.
ExtraFlip chooseExtraSlice(const LocalVertices& vertices, const LocalOctahedron& octahedron);

} // namespace vdbtet
