/// @file RankPart.cc
/// From all tiles to those of a rank.
#include "mpi/RankPart.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vdbtet::mpi {

using openvdb::Coord;

namespace {

/// Marks tiles of others as borrowed.
class Borrower {
public:
    Borrower(const Skeleton& skeleton, const Spans& spans, std::vector<TileRef>& refs, int rank)
        : mSkeleton(skeleton), mSpans(spans), mRefs(refs), mRank(rank) {}

    void borrowIn(const openvdb::CoordBBox& box) {
        mSpans.forEachIn(box, [&](std::int64_t s) {
            const TileRef tile = mSpans[s].tile;
            if (tile < 0 || mRefs[std::size_t(tile)] != kElsewhere) return;
            mRefs[std::size_t(tile)] = kBorrowed;
            mTiles.push_back({mSkeleton.owner(mSkeleton.tiles[std::size_t(tile)]), tile});
        });
    }

    /// Give those borrowed since the last call their references.
    /// @return them, in order
    std::vector<Borrowed> number(TileRef first) {
        std::sort(mTiles.begin(), mTiles.end(), [](const Borrowed& a, const Borrowed& b) {
            return std::tie(a.owner, a.tile) < std::tie(b.owner, b.tile);
        });
        for (const Borrowed& tile : mTiles) mRefs[std::size_t(tile.tile)] = first++;
        return std::move(mTiles);
    }

private:
    static constexpr TileRef kBorrowed = -4; ///< and not numbered yet

    const Skeleton& mSkeleton;
    const Spans& mSpans;
    std::vector<TileRef>& mRefs;
    int mRank;
    std::vector<Borrowed> mTiles;
};

openvdb::CoordBBox around(const Coord& first, std::int64_t count) {
    return openvdb::CoordBBox(first.offsetBy(-1), first.offsetBy(1, 1, int(count)));
}

} // namespace

TileRef firstSurface(const Spans& spans, const Coord& tile) {
    for (const std::int64_t span : spans.around(tile)) {
        if (span >= 0 && spans[span].tile != kInside) return spans[span].tile;
    }
    return kOutside;
}

RankPart makePart(Comm& comm, const Skeleton& skeleton, const std::vector<std::int64_t>& own,
                  const std::vector<TileEnds>& ends, bool graded) {
    // Each rank's tiles come in the order of all, so that a list of theirs needs no numbers.
    const std::vector<std::vector<TileEnds>> endsOf = comm.gather(ends);
    std::vector<TileEnds> allEnds;
    allEnds.reserve(skeleton.tiles.size());
    std::vector<std::size_t> next(endsOf.size(), 0);
    for (const Coord& tile : skeleton.tiles) {
        const auto rank = std::size_t(skeleton.owner(tile));
        allEnds.push_back(endsOf[rank][next[rank]++]);
    }
    Spans all;
    comm.together([&] { all = makeSpans(skeleton.tiles, allEnds); });

    RankPart part;
    std::vector<TileRef> refs(skeleton.tiles.size(), kElsewhere);
    for (std::size_t t = 0; t < own.size(); ++t) refs[std::size_t(own[t])] = TileRef(t);
    Borrower borrower(skeleton, all, refs, comm.rank());
    for (const std::int64_t tile : own) borrower.borrowIn(around(skeleton.tiles[std::size_t(tile)], 1));
    std::vector<Borrowed> beside = borrower.number(TileRef(own.size()));
    Ranges ranges;
    for (std::int64_t s = 0; s < all.size(); ++s) {
        const Span& span = all[s];
        if (span.tile >= 0) {
            const TileRef ref = refs[std::size_t(span.tile)];
            if (ref >= 0 && ref < TileRef(own.size())) ranges.add({s, 0}, {s + 1, 0});
            part.lowest.push_back(allEnds[std::size_t(span.tile)].lowest);
            continue;
        }
        part.lowest.push_back(true);
        forEachOwn(skeleton, span, comm.rank(), [&](std::int64_t begin, std::int64_t end) {
            ranges.addRun(s, span, begin, end);
            borrower.borrowIn(around(span.first.offsetBy(0, 0, int(begin)), end - begin));
        });
    }
    part.ranges = ranges.take();
    const auto isOwn = [&](TileRef tile) {
        return refs[std::size_t(tile)] >= 0 && refs[std::size_t(tile)] < TileRef(own.size());
    };
    for (std::size_t t = 0; t < own.size() && graded; ++t) {
        const Coord& tile = skeleton.tiles[std::size_t(own[t])];
        const SpansAround spans = all.around(tile);
        for (int slot = 0; slot < 27; ++slot) {
            if (spans[std::size_t(slot)] < 0 || all[spans[std::size_t(slot)]].tile >= 0) continue;
            const Coord inside = tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
            if (isOwn(firstSurface(all, inside))) borrower.borrowIn(around(inside, 1));
        }
    }
    const TileRef firstFar = TileRef(own.size() + beside.size());
    const std::vector<Borrowed> far = borrower.number(firstFar);

    Layout& layout = part.layout;
    layout.borrowed = std::int64_t(beside.size() + far.size());
    for (const std::int64_t tile : own) layout.surfaceTiles.push_back(skeleton.tiles[std::size_t(tile)]);
    for (const Borrowed& tile : beside) layout.surfaceTiles.push_back(skeleton.tiles[std::size_t(tile.tile)]);
    for (const Borrowed& tile : far) layout.surfaceTiles.push_back(skeleton.tiles[std::size_t(tile.tile)]);
    for (const Span& span : all)
        layout.spans.append(
            {span.first, span.count, span.tile < 0 ? span.tile : refs[std::size_t(span.tile)]});
    all = Spans();
    layout.neighbours.resize(own.size());
    for (std::size_t t = 0; t < own.size(); ++t) {
        const SpansAround spans = layout.spans.around(layout.surfaceTiles[t]);
        for (std::size_t slot = 0; slot < spans.size(); ++slot)
            layout.neighbours[t][slot] = spans[slot] < 0 ? kOutside : layout.spans[spans[slot]].tile;
    }
    part.beside = std::make_unique<TileExchange>(comm, own, beside, TileRef(own.size()));
    part.far = std::make_unique<TileExchange>(comm, own, far, firstFar);
    return part;
}

} // namespace vdbtet::mpi
