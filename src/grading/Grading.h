/// @file Grading.h
/// Which octants the inside is made of: uniform cells at the surface, and coarser ones away from it (the
/// paper's section 8.1, after Labelle and Shewchuk).
///
/// An octant of level l is a cube of 2^l cells an edge, aligned to multiples of 2^l. Those of level 0 are the
/// cells of the lattice. Octants may have any of their eight children; the vertices of the mesh are the
/// corners and the centres of octants that exist. Of the vertices only centres of level 0 are in L_B.
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "destinations/Changes.h"
#include "grading/LocalOctants.h"
#include "tiles/Layout.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdbtet {

/// The tile of the next tier that a tile is in, and its bit there.
inline openvdb::Coord parentOf(const openvdb::Coord& tile) {
    return openvdb::Coord(tile.x() >> 3, tile.y() >> 3, tile.z() >> 3);
}
inline int bitInParent(const openvdb::Coord& tile) {
    return TileMask::bit(tile.x() & 7, tile.y() & 7, tile.z() & 7);
}

/// @brief Three levels of octants in tiles of 8 units an edge, the unit being 8^t cells in tier t.
/// @details Tier 0 has the tiles of the layout. In tier t a tile holds octants of the levels 3t, 3t+1 and
/// 3t+2, and is itself one of level 3t+3. It has a record iff that one exists; any other tile owns at most
/// its lowest vertex, which is then the business of the next tier. Tiles that are wholly outside have none
/// in tier 0: no inside octant is next to one, so it does not matter what exists there.
struct Tier {
    Spans spans;                    ///< the records, and in the last tier runs of tiles all alike
    std::vector<OctantSet> octants; ///< of each record
    std::vector<TileRef> unitsOf;   ///< of each record: where its mask is in units, or -1
    std::vector<TileMask> units;    ///< octants of level 3t, of the tiles that have any
    std::vector<TileRef> surface;   ///< in tier 0, of each record: the surface tile, or kInside
    std::vector<TileMask> inside;   ///< above tier 0, of each record: the inside vertices
};

struct Grading {
    int top = 0;             ///< the level of the coarsest octants, all of which exist; 0 for a uniform mesh
    std::vector<Tier> tiers; ///< at least one

    /// The tier that has the coarsest octants, and their level in its tiles.
    int last() const { return int(tiers.size()) - 1; }
    int coarsest(int tier) const { return tier < last() ? 3 : top - 3 * last(); }

    /// @return the surface tile of a record, or kInside.
    TileRef surfaceOf(int tier, TileRef record) const {
        return tier > 0 || record < 0 ? kInside : top == 0 ? record : tiers[0].surface[record];
    }

    /// The vertices of a record that belong to the tier below, at the lowest corners of its records; null for
    /// none.
    const TileMask* lent(int tier, TileRef record) const {
        if (tier == 0 || record < 0) return nullptr;
        const TileRef units = tiers[tier].unitsOf[record];
        return units < 0 ? nullptr : &tiers[tier].units[units];
    }

    /// The vertices of L_A in a tile of a run.
    TileMask verticesInRun() const;

    /// @brief Unpack the surroundings of a tile of a graded mesh.
    /// @param around  the tier's spans around it
    void load(const Layout& layout, const std::vector<TileSigns>& signs, int tier, const openvdb::Coord& tile,
              const SpansAround& around, LocalOctants& octants) const;
};

/// @brief Choose the octants.
/// @param moved  of each surface tile and lattice, the vertices that are not at home
/// @param top    the level of the coarsest; 0 for a uniform mesh
/// @details A cell is an octant of level 0 iff a corner of it, its centre, or the centre of a face neighbour
/// is moved. So all tets at moved vertices are the lattice's own, and the boundary is the same as the
/// uniform mesh's. The others are those that weak balance then asks for.
Grading gradeInterior(const Layout& layout, const std::vector<TileSigns>& signs, const VertexMasks& moved,
                      int top, Interrupt& interrupt);

/// The octants of level 0 of a surface tile that are chosen for its vertices.
struct FinestOctants {
    openvdb::Coord tile;
    TileMask cells;
};

/// The first step of gradeInterior(), for the own tiles: those that have any, ascending.
std::vector<FinestOctants> findFinest(const Layout& layout, const VertexMasks& moved, Interrupt& interrupt);

/// @brief The other steps, for the whole mesh.
/// @param lowest  of each of the layout's spans, whether its lowest vertex is inside
/// @param finest  of all tiles, ascending; let go of at once
/// @param top     not 0
Grading gradeTiles(const Layout& layout, const std::vector<bool>& lowest, std::vector<FinestOctants> finest,
                   int top, Interrupt& interrupt);

/// The level from which on no coarser octant fits into the inside, or into the limit of edges.
/// @param mostCells  the limit, as a number of cells; default: none
int coarsestLevel(const Layout& layout, std::optional<double> mostCells);

} // namespace vdbtet
