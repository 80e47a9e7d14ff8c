/// @file Numbering.cc
/// Used vertices by dilation of masks, tets by masks; ids by count and scan.
#include "numbering/Numbering.h"

#include "tets/BoundaryFaces.h"
#include "tets/TileTets.h"

#include <vdbtet/VolumeToTets.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <memory>

namespace vdbtet {

namespace {

/// Where all around are alike.
constexpr std::int64_t kTetsPerOctant = 12;

/// Looks at one tile after another; one for each thread.
class TileNumberer {
public:
    TileNumberer(const Vertices& vertices, const Flips& flips, const Grading& grading, const Frame& frame)
        : tetsOfLevel(std::size_t(grading.top + 1)), mVertices(vertices), mGrading(grading), mFrame(frame),
          mTets(vertices, flips) {}

    /// @param used  receives the used vertices; nothing in L_B but of a surface tile
    SpanCounts number(int tier, const openvdb::Coord& tile, TileRef record, std::array<TileMask, 2>& used) {
        const bool graded = mGrading.top > 0;
        const TileRef surface = mGrading.surfaceOf(tier, record);
        if (graded) {
            const SpansAround around = mGrading.tiers[tier].spans.around(tile);
            mGrading.load(mVertices.layout, mVertices.signs, tier, tile, around, mOctants);
        }
        SpanCounts counts;
        if (surface >= 0) {
            counts = numberSurface(surface, used);
        } else {
            used[bcc::A] = mOctants.vertices();
            if (tier > 0) {
                used[bcc::A] &= mGrading.tiers[tier].inside[record];
                if (const TileMask* lent = mGrading.lent(tier, record)) used[bcc::A] &= ~*lent;
            } else if (mOctants.exists(0).any()) {
                // Cells of the tiles below, whose tets at the shared face belong here.
                mStates.load(mVertices, kInside);
                mStates.keepCells(mOctants.exists(0));
                mTets.load(kInside, mStates);
                counts.tets = mTets.tets();
                kinds[std::size_t(TetKind::Lattice)] += counts.tets;
                tetsOfLevel[0] += counts.tets;
            }
        }
        for (int level = 1; graded && level <= mOctants.coarsest(); ++level) {
            const std::int64_t ofLevel = countTetsOfLevel(level);
            tetsOfLevel[std::size_t(3 * tier + level)] += ofLevel;
            counts.tets += ofLevel;
        }
        counts.points = used[bcc::A].count() + used[bcc::B].count();
        if (const TileChanges* changes = mVertices.changesOf(surface))
            counts.points += std::int64_t(changes->copies.size());
        return counts;
    }

    /// Add the centroids of the ambiguous tets of the surface tile looked at last.
    void addAmbiguous(TileRef surface, std::vector<openvdb::Vec3d>& centroids) {
        mPositions.load(mVertices, surface);
        mTets.forEachAmbiguous([&](const LocalTet& tet) {
            openvdb::Vec3d sum(0.0);
            for (int i = 0; i < 4; ++i) sum += mPositions[tet.vertex(i)];
            centroids.push_back(mVertices.layout.origin(surface) + 0.25 * sum);
        });
    }

    std::array<std::int64_t, kTetKinds> kinds{};
    std::vector<std::int64_t> tetsOfLevel;
    openvdb::BBoxd bounds;

private:
    SpanCounts numberSurface(TileRef tile, std::array<TileMask, 2>& used) {
        const bool graded = mGrading.top > 0;
        mStates.load(mVertices, tile);
        if (graded) mStates.keepCells(mOctants.exists(0));
        mTets.load(tile, mStates);
        SpanCounts counts;
        const TileChanges* changes = mVertices.changesOf(tile);
        if (changes || mStates.manifoldMask(bcc::A).any() || mStates.manifoldMask(bcc::B).any()) {
            findChangedFaces(mVertices, tile, mTets, mStates, mFaces);
            counts.triangles = std::int32_t(mFaces.size());
        }
        counts.tets = mTets.tets();
        counts.ambiguous = std::int32_t(mTets.ambiguous());
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            used[lattice] = mStates.interiorMask(lattice).core();
            if (graded && lattice == bcc::A) used[lattice] &= mOctants.vertices();
            const TileMask& manifold = mVertices.labels.manifold[tile][lattice];
            TileMask outer;
            if (manifold.any()) outer = manifold & nextTo(mStates.interiorMasks(), lattice);
            used[lattice] |= outer;
            if (changes) {
                used[lattice] = (used[lattice] | changes->used[lattice]) & ~changes->unused[lattice];
                outer = used[lattice] & (manifold | changes->exposed[lattice]);
            }
            expandBounds(tile, lattice, outer);
        }
        if (graded) {
            forEachTetOfFringe(mOctants, mStates.interiorMask(bcc::B).core(),
                               [&](TetKind kind, int, int, int, int) {
                                   ++kinds[std::size_t(kind)];
                                   ++counts.tets;
                               });
        }
        tetsOfLevel[0] += counts.tets;
        return counts;
    }

    std::int64_t countTetsOfLevel(int level) {
        std::int64_t count = 0;
        forEachTetOfLevel(mOctants, level, [&](TetKind kind, int, int, int, int) {
            ++kinds[std::size_t(kind)];
            ++count;
        });
        return count;
    }

    /// All points lie in the convex hull of the outer ones.
    void expandBounds(TileRef tile, bcc::Lattice lattice, const TileMask& outer) {
        const openvdb::Vec3d origin = mVertices.layout.origin(tile);
        const TileMask& moved = mVertices.moved(tile, lattice);
        std::int64_t move = mVertices.firstMove(tile, lattice);
        moved.forEach([&](int n) {
            const openvdb::Vec3d to = homeOf(localIndex(lattice, n)) + mVertices.move(move++);
            if (outer.test(n)) bounds.expand(mFrame.world(origin + to));
        });
        (outer & ~moved).forEach([&](int n) {
            bounds.expand(mFrame.world(origin + homeOf(localIndex(lattice, n))));
        });
    }

    const Vertices& mVertices;
    const Grading& mGrading;
    const Frame& mFrame;
    LocalOctants mOctants;
    LocalStates mStates;
    TileTets mTets;
    LocalPositions mPositions;
    std::vector<LocalFace> mFaces;
};

} // namespace

Numbering numberMesh(const Vertices& vertices, const Flips& flips, const Grading& grading, const Frame& frame,
                     Interrupt& interrupt, OtherParts* others) {
    Numbering numbering;
    const int levelInRun = grading.coarsest(grading.last());
    numbering.usedInRun = {grading.verticesInRun(), TileMask::filled(grading.top == 0)};
    numbering.runPoints = numbering.usedInRun[bcc::A].count() + numbering.usedInRun[bcc::B].count();
    numbering.runTets = kTetsPerOctant * (TileMask::kSize >> 3 * levelInRun);
    numbering.tetsOfLevel.resize(std::size_t(grading.top + 1));
    numbering.usedA.resize(grading.tiers.size());
    numbering.usedB.resize(vertices.layout.surfaceTiles.size());
    tbb::enumerable_thread_specific<std::unique_ptr<TileNumberer>> numberers(
        [&] { return std::make_unique<TileNumberer>(vertices, flips, grading, frame); });

    numbering.firstSpan.push_back(0);
    for (auto* first : {&numbering.firstPoint, &numbering.firstTet, &numbering.firstTriangle})
        first->push_back(0);
    std::int64_t inRuns = 0;
    interrupt.expectLoops(1); // the higher tiers have few tiles
    for (int tier = 0; tier <= grading.last(); ++tier) {
        const Spans& spans = grading.tiers[tier].spans;
        std::vector<TileMask>& usedA = numbering.usedA[tier];
        usedA.resize(grading.top == 0 ? vertices.layout.surfaceTiles.size()
                                      : grading.tiers[tier].octants.size());
        std::vector<SpanCounts> counts(std::size_t(spans.size()));
        const auto isOwn = [&](const Span& span) {
            return span.tile >= 0 && (!others || others->isOwn(tier, span));
        };
        parallelRanges(spans.size(), interrupt, [&](std::int64_t begin, std::int64_t end) {
            TileNumberer& numberer = *numberers.local();
            for (std::int64_t s = begin; s < end; ++s) {
                const TileRef record = spans[s].tile;
                if (!isOwn(spans[s])) continue;
                std::array<TileMask, 2> used;
                counts[s] = numberer.number(tier, spans[s].first, record, used);
                usedA[record] = used[bcc::A];
                const TileRef surface = grading.surfaceOf(tier, record);
                if (surface >= 0) numbering.usedB[surface] = used[bcc::B];
            }
        });

        if (others) others->addCounts(tier, spans, counts);
        for (auto* first : {&numbering.firstPoint, &numbering.firstTet, &numbering.firstTriangle})
            first->reserve(first->size() + std::size_t(spans.size()));
        for (std::int64_t s = 0; s < spans.size(); ++s) {
            const Span& span = spans[s];
            if (span.tile == kInside) {
                counts[s].points = numbering.runPoints * span.count;
                counts[s].tets = numbering.runTets * span.count;
                inRuns += counts[s].tets;
            }
            numbering.firstPoint.push_back(numbering.points() + counts[s].points);
            numbering.firstTet.push_back(numbering.tets() + counts[s].tets);
            numbering.firstTriangle.push_back(numbering.triangles() + counts[s].triangles);
            numbering.ambiguous += counts[s].ambiguous;
        }
        // Ambiguous tets are rare, so their tiles are looked at once more instead of keeping lists for all.
        std::vector<openvdb::Vec3d>& places = numbering.ambiguousPlaces;
        const auto again = std::make_unique<TileNumberer>(vertices, flips, grading, frame);
        for (std::int64_t s = 0; s < spans.size() && places.size() < Places::kMost; ++s) {
            if (counts[s].ambiguous == 0 || !isOwn(spans[s])) continue;
            std::array<TileMask, 2> used;
            again->number(tier, spans[s].first, spans[s].tile, used);
            again->addAmbiguous(grading.surfaceOf(tier, spans[s].tile), places);
        }
        places.resize(std::min(places.size(), Places::kMost));
        numbering.firstSpan.push_back(numbering.firstSpan.back() + spans.size());
    }
    for (const auto& part : numberers) {
        numbering.bounds.expand(part->bounds);
        for (int kind = 0; kind < kTetKinds; ++kind) numbering.kinds[kind] += part->kinds[kind];
        for (std::size_t level = 0; level < part->tetsOfLevel.size(); ++level)
            numbering.tetsOfLevel[level] += part->tetsOfLevel[level];
    }
    if (others) others->addSums(numbering);
    numbering.kinds[std::size_t(TetKind::Lattice)] += inRuns;
    numbering.tetsOfLevel.back() += inRuns;
    return numbering;
}

} // namespace vdbtet
