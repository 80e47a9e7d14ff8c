/// @file PointIds.cc
/// Ids by rank in the used masks.
#include "emit/PointIds.h"

namespace vdbtet {

using openvdb::Coord;

namespace {

const TileMask kNone = TileMask::filled(false);

/// The lowest vertex of a tile, which is all it may have without a record.
const TileMask kLowest = [] {
    TileMask mask;
    mask.set(0);
    return mask;
}();

} // namespace

void PointIds::load(int tier, const Coord& tile, const SpansAround& around) {
    mTier = tier;
    mTile = tile;
    mAround = around;
    if (mGrading.top == 0) return;
    const Tier& own = mGrading.tiers[tier];
    for (int slot = 0; slot < 8; ++slot) {
        const int dx = slot >> 2, dy = slot >> 1 & 1, dz = slot & 1;
        const std::int64_t span = mAround[neighbourSlot(dx, dy, dz)];
        Upper& upper = mUpper[slot];
        upper.used = upper.lent = nullptr;
        if (span < 0) continue;
        const Ids ids = idsOf(tier, span, tile.z() + dz);
        upper.lent = mGrading.lent(tier, own.spans[span].tile);
        upper.used = ids.used[bcc::A];
        std::int64_t first = ids.first[bcc::A];
        for (int x = 0; x < TileMask::kDim; ++x) {
            upper.first[x] = first;
            first += countBits(upper.used->words[x]);
        }
    }
}

PointIds::Ids PointIds::idsOf(int tier, std::int64_t span, int tileZ) const {
    Ids ids;
    const std::int64_t number = mNumbering.firstSpan[tier] + span;
    const Span& s = mGrading.tiers[tier].spans[span];
    ids.first[bcc::A] = mNumbering.firstPoint[number];
    if (s.tile < 0) {
        ids.first[bcc::A] += mNumbering.runPoints * (std::int64_t(tileZ) - s.first.z());
        ids.used[bcc::A] = &mNumbering.usedInRun[bcc::A];
        ids.used[bcc::B] = &mNumbering.usedInRun[bcc::B];
    } else {
        const TileRef surface = mGrading.surfaceOf(tier, s.tile);
        ids.used[bcc::A] = &mNumbering.usedA[tier][s.tile];
        ids.used[bcc::B] = surface >= 0 ? &mNumbering.usedB[surface] : &kNone;
    }
    ids.first[bcc::B] = ids.first[bcc::A] + ids.used[bcc::A]->count();
    return ids;
}

PointIds::Ids PointIds::idsAround(int slot) const {
    const int dx = slot / 9 - 1, dy = slot / 3 % 3 - 1, dz = slot % 3 - 1;
    if (mAround[slot] >= 0) return idsOf(mTier, mAround[slot], mTile.z() + dz);
    Ids ids;
    ids.used[bcc::A] = ids.used[bcc::B] = &kNone;
    // Of a lower neighbour the lowest vertex is far away.
    if (mGrading.top > 0 && dx >= 0 && dy >= 0 && dz >= 0) {
        ids.used[bcc::A] = &kLowest;
        ids.first[bcc::A] = findAbove(mTier, mTile.offsetBy(dx, dy, dz));
    }
    return ids;
}

/// The id of a vertex of a record or a run that is not lent.
std::int64_t PointIds::idOf(int tier, std::int64_t span, const Coord& tile, int n) const {
    const Ids ids = idsOf(tier, span, tile.z());
    return ids.first[bcc::A] + ids.used[bcc::A]->rank(n);
}

std::int64_t PointIds::findAbove(int tier, Coord tile) const {
    while (tier < mGrading.last()) {
        const int n = bitInParent(tile);
        tile = parentOf(tile);
        const std::int64_t span = mGrading.tiers[++tier].spans.find(tile);
        if (span < 0) continue;
        const TileMask* lent = mGrading.lent(tier, mGrading.tiers[tier].spans[span].tile);
        return lent && lent->test(n) ? 0 : idOf(tier, span, tile, n); // a tile outside has lent it
    }
    return 0;
}

std::int64_t PointIds::findBelow(int tier, Coord tile, int n) const {
    for (;;) {
        tile = Coord(8 * tile.x() + (n >> 6), 8 * tile.y() + (n >> 3 & 7), 8 * tile.z() + (n & 7));
        n = 0;
        const std::int64_t span = mGrading.tiers[--tier].spans.find(tile);
        if (span < 0) return 0; // outside
        const TileMask* lent = mGrading.lent(tier, mGrading.tiers[tier].spans[span].tile);
        if (!lent || !lent->test(n)) return idOf(tier, span, tile, n);
    }
}

std::int64_t PointIds::copyOf(int local, int copy) const {
    const int n = bitOf(local);
    const Ids ids = idsAround(
        neighbourSlot(tileStep(PaddedMask::x(n)), tileStep(PaddedMask::y(n)), tileStep(PaddedMask::z(n))));
    return ids.first[bcc::B] + ids.used[bcc::B]->count() + copy;
}

void PointIds::findAll() {
    for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
            Ids column[3];
            for (int dz = -1; dz <= 1; ++dz) column[dz + 1] = idsAround(neighbourSlot(dx, dy, dz));
            const int x0 = dx < 0 ? -1 : 8 * dx, x1 = dx == 0 ? 7 : x0;
            const int y0 = dy < 0 ? -1 : 8 * dy, y1 = dy == 0 ? 7 : y0;
            for (int lattice = 0; lattice < 2; ++lattice) {
                for (int x = x0; x <= x1; ++x) {
                    Slab slabs[3];
                    for (int z = 0; z < 3; ++z) slabs[z] = slabOf(column[z], lattice, x & 7);
                    for (int y = y0; y <= y1; ++y)
                        findRow(slabs, y & 7, mIds.data() + localIndex(lattice, x, y, 0));
                }
            }
        }
    }
}

PointIds::Slab PointIds::slabOf(const Ids& ids, int lattice, int x) {
    const TileMask& used = *ids.used[lattice];
    return {ids.first[lattice] + used.rank(x << 6), used.words[x]};
}

/// The ids of a row from -1 to 8 in three tiles above each other.
void PointIds::findRow(const Slab (&slabs)[3], int y, std::int64_t* row) {
    const auto idAt = [&](const Slab& slab, int n) {
        return slab.first + countBits(slab.used & ((std::uint64_t(1) << n) - 1));
    };
    row[-1] = idAt(slabs[0], 8 * y + 7);
    const std::int64_t before = idAt(slabs[1], 8 * y);
    const unsigned bits = unsigned(slabs[1].used >> (8 * y) & 0xff);
    if (bits == 0xff) {
        for (int z = 0; z < 8; ++z) row[z] = before + z;
    } else {
        for (int z = 0; z < 8; ++z) row[z] = before + countBits(bits & ((1u << z) - 1));
    }
    row[8] = idAt(slabs[2], 8 * y);
}

} // namespace vdbtet
