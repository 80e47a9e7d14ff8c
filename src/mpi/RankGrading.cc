/// @file RankGrading.cc
/// All octants on all ranks; counts and used vertices by tier.
#include "mpi/RankGrading.h"

#include <tbb/parallel_sort.h>

#include <utility>

namespace vdbtet::mpi {

Grading gradePart(Comm& comm, const RankPart& part, const std::vector<TileSigns>& signs,
                  const VertexMasks& moved, int top, Interrupt& interrupt) {
    if (top == 0) return gradeInterior(part.layout, signs, moved, 0, interrupt);
    std::vector<FinestOctants> own, all;
    comm.together([&] { own = findFinest(part.layout, moved, interrupt); });
    comm.forEachRank(own, [&](const auto& some) { all.insert(all.end(), some.begin(), some.end()); });
    std::vector<FinestOctants>().swap(own);
    tbb::parallel_sort(all.begin(), all.end(),
                       [](const FinestOctants& a, const FinestOctants& b) { return a.tile < b.tile; });
    Grading grading;
    comm.together([&] { grading = gradeTiles(part.layout, part.lowest, std::move(all), top, interrupt); });
    return grading;
}

OtherRanks::OtherRanks(Comm& comm, const Layout& layout, const Grading& grading)
    : mComm(comm), mLayout(layout), mGrading(grading) {
    if (grading.top == 0) return;
    for (int tier = 0; tier <= grading.last(); ++tier) {
        const Tier& its = grading.tiers[std::size_t(tier)];
        std::vector<bool>& own = mOwn.emplace_back(its.octants.size());
        for (const Span& span : its.spans) {
            if (span.tile < 0) continue;
            const auto record = std::size_t(span.tile);
            if (tier > 0) {
                own[record] = dealt(span.tile, std::int64_t(its.octants.size())) == comm.rank();
                continue;
            }
            TileRef surface = its.surface[record];
            if (surface == kInside) surface = firstSurface(layout.spans, span.first);
            own[record] = surface >= 0 && surface < layout.ownCount();
        }
    }
}

void OtherRanks::addCounts(int tier, const Spans& spans, std::vector<SpanCounts>& counts) {
    struct Counted {
        std::int64_t span;
        SpanCounts counts;
    };
    std::vector<Counted> own;
    for (std::int64_t s = 0; s < spans.size(); ++s) {
        if (isOwn(tier, spans[s])) own.push_back({s, counts[std::size_t(s)]});
    }
    mComm.forEachRank(own, [&](const auto& some) {
        for (const Counted& one : some) counts[std::size_t(one.span)] = one.counts;
    });
}

void OtherRanks::addSums(Numbering& numbering) {
    mComm.sum(numbering.kinds.data(), numbering.kinds.size());
    mComm.sum(numbering.tetsOfLevel.data(), numbering.tetsOfLevel.size());
    openvdb::Vec3d low = numbering.bounds.min(), high = numbering.bounds.max();
    for (int axis = 0; axis < 3; ++axis) {
        mComm.least(low[axis]);
        mComm.most(high[axis]);
    }
    numbering.bounds = openvdb::BBoxd(low, high);
}

void OtherRanks::addUsed(const RankPart& part, Numbering& numbering) const {
    for (const TileExchange* exchange : {part.beside.get(), part.far.get()}) {
        exchange->exchange(numbering.usedB);
        if (mGrading.top == 0) exchange->exchange(numbering.usedA[0]);
    }
    // Ids of a graded mesh are looked up far away.
    struct Used {
        std::int64_t record;
        TileMask mask;
    };
    for (std::size_t tier = 0; tier < mOwn.size(); ++tier) {
        std::vector<Used> own;
        for (std::size_t record = 0; record < mOwn[tier].size(); ++record) {
            if (mOwn[tier][record]) own.push_back({std::int64_t(record), numbering.usedA[tier][record]});
        }
        mComm.forEachRank(own, [&](const auto& some) {
            for (const Used& one : some) numbering.usedA[tier][std::size_t(one.record)] = one.mask;
        });
    }
}

std::vector<TileRange> OtherRanks::ranges(const RankPart& part, const Skeleton& skeleton,
                                          const Numbering& numbering) const {
    if (mGrading.top == 0) return part.ranges;
    Ranges ranges;
    for (int tier = 0; tier <= mGrading.last(); ++tier) {
        const Spans& spans = mGrading.tiers[std::size_t(tier)].spans;
        for (std::int64_t s = 0; s < spans.size(); ++s) {
            const std::int64_t number = numbering.firstSpan[std::size_t(tier)] + s;
            if (spans[s].tile >= 0) {
                if (isOwn(tier, spans[s])) ranges.add({number, 0}, {number + 1, 0});
            } else if (tier == 0) {
                forEachOwn(skeleton, spans[s], mComm.rank(), [&](std::int64_t begin, std::int64_t end) {
                    ranges.addRun(number, spans[s], begin, end);
                });
            } else if (dealt(s, spans.size()) == mComm.rank()) {
                ranges.add({number, 0}, {number + 1, 0});
            }
        }
    }
    return ranges.take();
}

} // namespace vdbtet::mpi
