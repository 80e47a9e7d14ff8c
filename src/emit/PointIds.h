/// @file PointIds.h
/// The ids of the points in and around one tile.
#pragma once

#include "numbering/Numbering.h"

#include <array>
#include <cstdint>

namespace vdbtet {

/// One for each thread.
class PointIds {
public:
    PointIds(const Grading& grading, const Numbering& numbering) : mGrading(grading), mNumbering(numbering) {}

    /// Go to a tile of a tier, and the spans around it.
    void load(int tier, const openvdb::Coord& tile, const SpansAround& around);

    /// Look up all vertices in and around the tile, of tier 0.
    void findAll();

    /// Their ids, by local number; those of unused vertices are arbitrary.
    const std::int64_t* local() const { return mIds.data(); }

    /// The id of point number @a copy of TileChanges::copies, of the tile around that has vertex @a local.
    std::int64_t copyOf(int local, int copy) const;

    /// The id of a vertex of L_A that is not beyond an upper neighbour, in units.
    std::int64_t at(int point) const {
        const Upper& upper = mUpper[upperSlot(point)];
        const int n = unitBit(point);
        if (!upper.used) return findAbove(mTier, tileOf(point));
        if (upper.lent && upper.lent->test(n)) return findBelow(mTier, tileOf(point), n);
        const std::uint64_t below = (std::uint64_t(1) << (n & 63)) - 1;
        return upper.first[n >> 6] + countBits(upper.used->words[n >> 6] & below);
    }

private:
    /// The ids of the points of a tile.
    struct Ids {
        std::int64_t first[2] = {0, 0}; ///< by lattice
        const TileMask* used[2];        ///< which vertices have one
    };

    /// Those of a slab of equal x.
    struct Slab {
        std::int64_t first;
        std::uint64_t used;
    };

    /// Those of L_A in an upper neighbour, or the tile itself.
    struct Upper {
        const TileMask* used;  ///< null for a tile without a record
        const TileMask* lent;  ///< vertices that belong to the tier below, or null
        std::int64_t first[8]; ///< by slab
    };

    Ids idsOf(int tier, std::int64_t span, int tileZ) const;
    Ids idsAround(int slot) const;
    std::int64_t idOf(int tier, std::int64_t span, const openvdb::Coord& tile, int n) const;
    /// The id of the lowest vertex of a tile without a record: a corner or centre in a tier above. Arbitrary
    /// if there is none in the mesh.
    std::int64_t findAbove(int tier, openvdb::Coord tile) const;
    /// The id of a vertex that a tile has lent to the tiers below; arbitrary outside.
    std::int64_t findBelow(int tier, openvdb::Coord tile, int n) const;
    openvdb::Coord tileOf(int point) const {
        return mTile.offsetBy(unitX(point) >> 3, unitY(point) >> 3, unitZ(point) >> 3);
    }
    static Slab slabOf(const Ids& ids, int lattice, int x);
    static void findRow(const Slab (&slabs)[3], int y, std::int64_t* row);

    const Grading& mGrading;
    const Numbering& mNumbering;
    int mTier = 0;
    openvdb::Coord mTile;
    SpansAround mAround{};
    std::array<Upper, 8> mUpper{}; ///< by upperSlot()
    std::array<std::int64_t, kLocalVertices> mIds{};
};

} // namespace vdbtet
