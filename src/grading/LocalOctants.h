/// @file LocalOctants.h
/// The octants in and around one tile, for the stages that look at tets.
#pragma once

#include "bits/PaddedMask.h"
#include "grading/Closure.h"

#include <openvdb/Types.h>

#include <array>

namespace vdbtet {

/// A vertex seen from a tile's lower corner, its coordinates in units, from 0 to 15. Steps are differences.
constexpr int unitPoint(int x, int y, int z) { return x << 8 | y << 4 | z; }
constexpr int unitX(int point) { return point >> 8; }
constexpr int unitY(int point) { return point >> 4 & 15; }
constexpr int unitZ(int point) { return point & 15; }

/// The tile among the 8 upper neighbours, itself included, that owns a vertex: 4, 2 and 1 for one up along
/// x, y and z.
constexpr int upperSlot(int point) {
    return (point >> 11 & 1) << 2 | (point >> 7 & 1) << 1 | (point >> 3 & 1);
}
/// The vertex's bit in the masks of that tile.
constexpr int unitBit(int point) {
    return TileMask::bit(unitX(point) & 7, unitY(point) & 7, unitZ(point) & 7);
}

/// One of the tiles around.
struct OctantPart {
    const TileMask* units = nullptr;  ///< the octants of level 0; null for none
    OctantSet set;                    ///< those above
    const TileMask* inside = nullptr; ///< its inside vertices; null for none
};

class LocalOctants {
public:
    static constexpr int kLevels = 4;

    /// @param parts   the tile and its neighbours, by neighbourSlot()
    /// @param tile    its coordinates
    /// @param coarsest  the level of the coarsest octants, from 1 to 3
    void load(const std::array<OctantPart, 27>& parts, const openvdb::Coord& tile, int coarsest);

    int coarsest() const { return mCoarsest; }

    /// The octants of a level that exist, by PaddedMask::bit() of coordinates from -1 to 8 >> level in units
    /// of their edge.
    const PaddedMask& exists(int level) const { return mExists[level]; }

    /// The corners of the octants of a level, from 0 to 8 >> level; not of level 3.
    const PaddedMask& corners(int level) const { return mCorners[level]; }

    /// Whether a vertex, not beyond an upper neighbour, is inside.
    bool inside(int point) const {
        const TileMask* mask = mInside[upperSlot(point)];
        return mask && mask->test(unitBit(point));
    }

    /// The vertices in the tile: corners of octants, and centres but those of level 0.
    TileMask vertices() const;

    /// The sum of the coordinates, modulo 2, of octant (x,y,z) of a level in the plane across @a axis. Odd
    /// and even are the same seen from any tile.
    int parity(int level, int axis, int x, int y, int z) const {
        const int at[3] = {x, y, z};
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int local = at[u] + at[v];
        return (level < 3 ? local : local + mTile[u] + mTile[v]) & 1;
    }

private:
    std::array<PaddedMask, kLevels> mExists;
    std::array<PaddedMask, kLevels - 1> mCorners;
    std::array<const TileMask*, 8> mInside; ///< by upperSlot()
    openvdb::Coord mTile;
    int mCoarsest = 3;
};

} // namespace vdbtet
