/// @file Octree.h
/// Octrees of a periodic box that is all inside, their tets, and what is wrong with them.
#pragma once

#include "tets/GradedTets.h"

#include <array>
#include <cstdint>
#include <set>
#include <vector>

namespace vdbtet::test {

/// @brief A box of tiles that repeats itself along all axes, so that nothing has a boundary.
/// @details Any number of tiles will do. Half-pyramids depend on whether octants have odd or even places:
/// below level 3 there is an even number along a tile's edge, and those of level 3, the coarsest, have none.
struct Octree {
    int tiles; ///< along an axis
    int coarsest;
    std::vector<TileMask> cells;    ///< the octants of level 0, by number()
    std::vector<OctantSet> octants; ///< those above

    int edge() const { return tiles * TileMask::kDim; } ///< in cells
    std::size_t number(const openvdb::Coord& tile) const;
    bool hasCell(const openvdb::Coord& cell) const;
    LocalOctants around(const openvdb::Coord& tile) const;

    /// Call @a visit(tile) for each tile.
    template <typename Visit>
    void forEachTile(Visit&& visit) const {
        for (int x = 0; x < tiles; ++x) {
            for (int y = 0; y < tiles; ++y) {
                for (int z = 0; z < tiles; ++z) visit(openvdb::Coord(x, y, z));
            }
        }
    }
};

/// The octree that closeOctants() makes of some cells, @a tiles cubed masks.
Octree closedOctree(int tiles, int coarsest, const std::vector<TileMask>& cells);

/// Octants by level, each level in units of its edge.
using Octants = std::array<std::set<openvdb::Coord>, LocalOctants::kLevels>;

/// @brief Weak balance by its definition: the parents of every octant and of its neighbours.
/// @param reach   along how many axes a neighbour may be one off: 1 for those at faces, 2 for edges also
/// @param period  of the cells, or 0 if they do not repeat themselves
Octants balanced(const std::set<openvdb::Coord>& cells, int reach, int period);

/// The octree by definition.
Octree balancedOctree(int tiles, int coarsest, const std::vector<TileMask>& cells, int reach);

/// Vertices are in half cells, where corners of cells are even and their centres odd. They are not wrapped:
/// a tet may be as long as the box.
struct OctreeTet {
    TetKind kind;
    int level; ///< of its coarsest octant
    std::array<openvdb::Coord, 4> points;
};

std::vector<OctreeTet> tetsOf(const Octree& octree);

/// All are 0 for a good mesh.
struct OctreeFaults {
    std::int64_t misshapen = 0;      ///< tets whose volume or angles are not those of their kind
    std::int64_t volume = 0;         ///< too much, in units of 1/48 of a cell
    std::int64_t unmatchedFaces = 0; ///< not in exactly two tets, one on either side
    std::int64_t wrongVertices = 0;  ///< used, but not in LocalOctants::vertices() or a cell; or conversely

    bool fillsSpace() const { return volume == 0 && unmatchedFaces == 0; }
};

OctreeFaults faultsOf(const Octree& octree, const std::vector<OctreeTet>& tets);

} // namespace vdbtet::test
