/// @file Grading.cc
/// From labels to octants, a tier at a time.
#include "grading/Grading.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace vdbtet {

using openvdb::Coord;

namespace {

const TileMask kAll = TileMask::filled(true);

/// What a tile without a record has inside the shape, or outside, where everything may be taken to exist.
OctantSet allAlike(int coarsest) {
    OctantSet set;
    if (coarsest <= 1) set.level1 = ~std::uint64_t(0);
    if (coarsest <= 2) set.level2 = 0xff;
    set.level3 = coarsest <= 3;
    return set;
}

/// The cells of a surface tile that must be octants.
TileMask finestCells(const Layout& layout, const VertexMasks& moved, TileRef tile) {
    const Surroundings around(layout.neighbours[tile]);
    const PaddedMask a(around.masks(moved, bcc::A)), b(around.masks(moved, bcc::B));
    TileMask cells = b.core();
    for (int step : {-1, 1}) cells |= b.shifted(step, 0, 0) | b.shifted(0, step, 0) | b.shifted(0, 0, step);
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step corner = bcc::shortEdge(bcc::B, d);
        cells |= a.shifted(corner.x, corner.y, corner.z);
    }
    return cells;
}

/// The tiles that hold octants of a tier's lowest level.
struct Units {
    Spans tiles; ///< ascending, and so are the masks
    std::vector<TileMask> masks;

    void append(const Coord& tile, const TileMask& mask) {
        tiles.append({tile, 1, TileRef(masks.size())});
        masks.push_back(mask);
    }
};

/// The tiles of @a tiles and their neighbours, in order.
std::vector<Coord> dilated(const Spans& tiles) {
    std::vector<Coord> along;
    for (const Span& span : tiles) {
        for (int dz = -1; dz <= 1; ++dz) {
            const Coord tile = span.first.offsetBy(0, 0, dz);
            if (along.empty() || along.back() < tile) along.push_back(tile);
        }
    }
    for (const Coord& step : {Coord(0, 1, 0), Coord(1, 0, 0)}) {
        std::vector<Coord> lower(along), upper(along), two, three;
        for (Coord& tile : lower) tile -= step;
        for (Coord& tile : upper) tile += step;
        two.reserve(2 * along.size());
        std::set_union(lower.begin(), lower.end(), along.begin(), along.end(), std::back_inserter(two));
        three.reserve(3 * along.size());
        std::set_union(two.begin(), two.end(), upper.begin(), upper.end(), std::back_inserter(three));
        along = std::move(three);
    }
    return along;
}

/// Whether a vertex at the lower corner of a tile of the layout is inside.
bool insideAt(const Layout& layout, const std::vector<bool>& lowest, const Coord& tile) {
    const std::int64_t span = layout.spans.find(tile);
    return span >= 0 && lowest[std::size_t(span)];
}

/// Makes one tier after the other, each from the records of the one before.
class TierMaker {
public:
    TierMaker(const Layout& layout, const std::vector<bool>& lowest, Units units, Interrupt& interrupt)
        : mLayout(layout), mLowest(lowest), mUnits(std::move(units)), mInterrupt(interrupt) {}

    /// @param coarsest  the level of the coarsest octants in the tier's tiles
    Tier next(int coarsest, bool last) {
        findCandidates();
        Tier tier;
        for (std::size_t c = 0; c < mCandidates.size(); ++c) {
            const Candidate& candidate = mCandidates[c];
            if (!candidate.octants.level3) continue;
            if (!last) mChildren.push_back(mTiles[c]);
            if (candidate.surface == kOutside) continue;
            if (last) fillGap(tier, mTiles[c]);
            tier.spans.append({mTiles[c], 1, TileRef(tier.octants.size())});
            tier.octants.push_back(candidate.octants);
            // All of the coarsest exist.
            if (last && coarsest == 1) tier.octants.back().level1 = ~std::uint64_t(0);
            if (last && coarsest == 2) tier.octants.back().level2 = 0xff;
            tier.unitsOf.push_back(candidate.units);
            if (mUnit == 1) tier.surface.push_back(candidate.surface);
        }
        tier.units = std::move(mUnits.masks);
        if (mUnit > 1) findInside(tier);
        mUnit *= TileMask::kDim;
        if (!last) mUnits = takeChildren();
        return tier;
    }

private:
    struct Candidate {
        OctantSet octants;
        TileRef units;
        TileRef surface; ///< above tier 0 always kInside
    };

    /// Octants reach no farther than into the next tile.
    void findCandidates() {
        mTiles = dilated(mUnits.tiles);
        mCandidates.resize(mTiles.size());
        parallelRanges(std::int64_t(mTiles.size()), mInterrupt, [&](std::int64_t begin, std::int64_t end) {
            std::array<const TileMask*, 27> units;
            for (std::int64_t c = begin; c < end; ++c) {
                const auto around = mUnits.tiles.around(mTiles[c]);
                for (int slot = 0; slot < 27; ++slot)
                    units[slot] = around[slot] < 0 ? nullptr : &mUnits.masks[around[slot]];
                const TileRef own = TileRef(around[neighbourSlot(0, 0, 0)]);
                mCandidates[c] = {closeOctants(units), own, kInside};
                if (mUnit > 1) continue;
                const std::int64_t span = mLayout.spans.find(mTiles[c]);
                mCandidates[c].surface = span < 0 ? kOutside : mLayout.spans[span].tile;
            }
        });
    }

    /// What lies in the last tier between two records of a column is of one sign, and all alike.
    void fillGap(Tier& tier, const Coord& tile) const {
        if (tier.spans.size() == 0) return;
        const Coord& below = tier.spans[tier.spans.size() - 1].first;
        if (below.x() != tile.x() || below.y() != tile.y() || below.z() + 1 == tile.z()) return;
        const Coord first = below.offsetBy(0, 0, 1);
        if (isInside(first, 0, 0, 0)) tier.spans.append({first, std::int64_t(tile.z()) - first.z(), kInside});
    }

    /// @return whether the vertex (x,y,z) of a tile of this tier is inside.
    bool isInside(const Coord& tile, int x, int y, int z) const {
        const std::int64_t step = mUnit / TileMask::kDim; // in tiles of the layout
        if (step == 0) return insideAt(mLayout, mLowest, tile);
        constexpr std::int64_t kFar = std::int64_t(1) << 30; // beyond all tiles of the layout
        const int vertex[3] = {x, y, z};
        Coord at;
        for (int i = 0; i < 3; ++i) {
            const std::int64_t place = step * (std::int64_t(TileMask::kDim) * tile[i] + vertex[i]);
            if (std::abs(place) > kFar) return false;
            at[i] = int(place);
        }
        return insideAt(mLayout, mLowest, at);
    }

    void findInside(Tier& tier) const {
        tier.inside.resize(tier.octants.size());
        parallelRanges(tier.spans.size(), mInterrupt, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t s = begin; s < end; ++s) {
                const Span& span = tier.spans[s];
                if (span.tile < 0) continue;
                for (int n = 0; n < TileMask::kSize; ++n) {
                    if (isInside(span.first, n >> 6, n >> 3 & 7, n & 7)) tier.inside[span.tile].set(n);
                }
            }
        });
    }

    /// The records of this tier, as octants of the next.
    Units takeChildren() {
        tbb::parallel_sort(mChildren.begin(), mChildren.end(), [](const Coord& a, const Coord& b) {
            const Coord parentA = parentOf(a), parentB = parentOf(b);
            return parentA != parentB ? parentA < parentB : a < b;
        });
        Units units;
        for (std::size_t c = 0; c < mChildren.size();) {
            const Coord parent = parentOf(mChildren[c]);
            TileMask mask;
            for (; c < mChildren.size() && parentOf(mChildren[c]) == parent; ++c)
                mask.set(bitInParent(mChildren[c]));
            units.append(parent, mask);
        }
        mChildren.clear();
        return units;
    }

    const Layout& mLayout;
    const std::vector<bool>& mLowest;
    Units mUnits;
    Interrupt& mInterrupt;
    std::int64_t mUnit = 1; ///< of the tier, in cells
    std::vector<Coord> mTiles;
    std::vector<Candidate> mCandidates; ///< of mTiles
    std::vector<Coord> mChildren;
};

} // namespace

int coarsestLevel(const Layout& layout, std::optional<double> mostCells) {
    openvdb::CoordBBox box;
    for (const Span& span : layout.spans) {
        if (span.tile != kInside) box.expand(span.first);
    }
    const Coord low = box.min(), high = box.max();
    std::int64_t tiles = 1;
    for (int axis = 0; axis < 3; ++axis)
        tiles = std::max(tiles, std::int64_t(high[axis]) - std::int64_t(low[axis]) + 1);
    int level = 3;
    while (std::int64_t(1) << (level - 3) < tiles) ++level;
    return mostCells ? std::min(level, int(std::floor(std::log2(*mostCells)))) : level;
}

std::vector<FinestOctants> findFinest(const Layout& layout, const VertexMasks& moved, Interrupt& interrupt) {
    std::vector<TileMask> cells(std::size_t(layout.ownCount()));
    parallelRanges(layout.ownCount(), interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) cells[t] = finestCells(layout, moved, TileRef(t));
    });
    std::vector<FinestOctants> finest;
    for (std::size_t t = 0; t < cells.size(); ++t) {
        if (cells[t].any()) finest.push_back({layout.surfaceTiles[t], cells[t]});
    }
    return finest;
}

Grading gradeTiles(const Layout& layout, const std::vector<bool>& lowest, std::vector<FinestOctants> finest,
                   int top, Interrupt& interrupt) {
    Grading grading;
    grading.top = top;
    Units units;
    for (const FinestOctants& octants : finest) units.append(octants.tile, octants.cells);
    std::vector<FinestOctants>().swap(finest);
    TierMaker maker(layout, lowest, std::move(units), interrupt);
    const int last = (top - 1) / 3;
    for (int tier = 0; tier <= last && !interrupt.stopped(); ++tier)
        grading.tiers.push_back(maker.next(tier < last ? 3 : top - 3 * last, tier == last));
    return grading;
}

Grading gradeInterior(const Layout& layout, const std::vector<TileSigns>& signs, const VertexMasks& moved,
                      int top, Interrupt& interrupt) {
    if (top == 0) {
        Grading grading;
        grading.tiers.resize(1);
        grading.tiers[0].spans = layout.spans;
        return grading;
    }
    std::vector<bool> lowest;
    for (const Span& span : layout.spans)
        lowest.push_back(span.tile == kInside || TileEnds::of(signs[span.tile]).lowest);
    return gradeTiles(layout, lowest, findFinest(layout, moved, interrupt), top, interrupt);
}

TileMask Grading::verticesInRun() const {
    if (top == 0) return kAll;
    std::array<OctantPart, 27> parts;
    for (OctantPart& part : parts) part.set = allAlike(coarsest(last()));
    LocalOctants octants;
    octants.load(parts, Coord(0), coarsest(last()));
    return octants.vertices();
}

void Grading::load(const Layout& layout, const std::vector<TileSigns>& signs, int tier, const Coord& tile,
                   const SpansAround& around, LocalOctants& octants) const {
    const Tier& own = tiers[tier];
    const std::int64_t centre = around[neighbourSlot(0, 0, 0)];
    const TileRef surface = surfaceOf(tier, own.spans[centre].tile);
    std::array<OctantPart, 27> parts;
    for (int slot = 0; slot < 27; ++slot) {
        OctantPart& part = parts[slot];
        const TileRef record = around[slot] < 0 ? kOutside : own.spans[around[slot]].tile;
        if (record < 0) {
            if (tier == last()) part.set = allAlike(coarsest(tier));
            if (record == kInside) part.inside = &kAll;
            // Next to the surface a tile outside has no record, and counts as existing.
            if (surface >= 0 && layout.neighbours[surface][slot] == kOutside) {
                part.units = &kAll;
                part.set = allAlike(0);
            }
            continue;
        }
        part.set = own.octants[record];
        if (own.unitsOf[record] >= 0) part.units = &own.units[own.unitsOf[record]];
        const TileRef neighbour = surfaceOf(tier, record);
        part.inside = tier > 0 ? &own.inside[record] : neighbour >= 0 ? &signs[neighbour][bcc::A] : &kAll;
    }
    octants.load(parts, tile, coarsest(tier));
}

} // namespace vdbtet
