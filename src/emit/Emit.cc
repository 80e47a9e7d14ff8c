/// @file Emit.cc
/// Chunks of tiles, in parallel.
#include "emit/Emit.h"

#include "emit/TileEmitter.h"
#include "simd/Stream.h"

#include <tbb/concurrent_queue.h>
#include <tbb/concurrent_vector.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace vdbtet {

namespace {

/// A chunk has at least this many tets, but for the last: few enough for the cache, enough that threads
/// seldom wait for each other at the file.
constexpr std::int64_t kTetsPerChunk = std::int64_t(1) << 16;

/// A span where it lies.
struct Located {
    int tier;
    std::int64_t span; ///< in the tier
};

Located locate(const Numbering& numbering, std::int64_t span) {
    int tier = 0;
    while (span >= numbering.firstSpan[tier + 1]) ++tier;
    return {tier, span - numbering.firstSpan[tier]};
}

/// Cuts ranges into chunks.
class Units {
public:
    Units(const Grading& grading, const Numbering& numbering, const std::vector<TileRange>& ranges)
        : mGrading(grading), mNumbering(numbering), mRanges(ranges) {
        if (!done()) mNext = mRanges[0].begin;
    }

    bool done() const { return mRange == mRanges.size(); }

    TileRange next() {
        const Place end = mRanges[mRange].end;
        const auto atEnd = [&] { return mNext.span == end.span && mNext.offset == end.offset; };
        TileRange unit{mNext, mNext};
        for (std::int64_t tets = 0; tets < kTetsPerChunk && !atEnd();) {
            const Located at = locate(mNumbering, mNext.span);
            const Span& span = mGrading.tiers[at.tier].spans[at.span];
            const std::int64_t last = mNext.span == end.span ? end.offset : span.count;
            std::int64_t left = last - mNext.offset, taken = left;
            if (span.tile < 0) {
                const std::int64_t perTile = mNumbering.runTets;
                taken = std::min(left, (kTetsPerChunk - tets + perTile - 1) / perTile);
                tets += perTile * taken;
            } else {
                tets += mNumbering.firstTet[mNext.span + 1] - mNumbering.firstTet[mNext.span];
            }
            mNext.offset += taken;
            if (mNext.offset == span.count) mNext = {mNext.span + 1, 0};
        }
        unit.end = mNext;
        if (atEnd() && ++mRange < mRanges.size()) mNext = mRanges[mRange].begin;
        return unit;
    }

private:
    const Grading& mGrading;
    const Numbering& mNumbering;
    const std::vector<TileRange>& mRanges;
    std::size_t mRange = 0;
    Place mNext;
};

/// A chunk on its way to the sink, and memory for it if the sink has none. Fresh pages cost more than the
/// tets that fill them, so parcels go round.
struct Parcel {
    MeshChunk chunk;
    std::vector<openvdb::Vec3d> points;
    std::vector<Tet> tets;
    ChunkBoundary boundary;
    TetShapes shapes;

    explicit Parcel(const MeshWants& wants) : shapes(wants) {}

    ChunkMemory memory(std::size_t nPoints, std::size_t nTets) {
        if (points.size() < nPoints) points.resize(nPoints);
        if (tets.size() < nTets) tets.resize(nTets);
        return {points.data(), tets.data()};
    }
};

/// @brief What a task of the pipeline does from its begin to its end, or the pipeline as a whole.
/// @details Whoever comes or goes sees what those before have written. TBB takes care of that as well, but
/// the thread sanitizer does not see into its pipeline, only this.
class Visit {
public:
    explicit Visit(std::atomic<std::uint64_t>& count) : mCount(count) { meet(); }
    ~Visit() { meet(); }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

private:
    void meet() { mCount.fetch_add(1, std::memory_order_acq_rel); }

    std::atomic<std::uint64_t>& mCount;
};

using Emitters = tbb::enumerable_thread_specific<std::unique_ptr<TileEmitter>>;

AngleSum sumOf(Emitters& emitters, const Numbering& numbering) {
    AngleSum sum;
    for (auto& emitter : emitters) sum.add(emitter->measured());
    for (int kind = 0; kind < kTetKinds; ++kind) sum.addKnown(kAnglesOfKind[kind], numbering.kinds[kind]);
    return sum;
}

class Emission {
public:
    Emission(const Grading& grading, const Numbering& numbering, Emitters& emitters, MeshSink& sink,
             Interrupt& interrupt)
        : mGrading(grading), mNumbering(numbering), mEmitters(emitters), mSink(sink), mInterrupt(interrupt),
          mWants(sink.wants()) {}

    void run(const std::vector<TileRange>& ranges) {
        Units units(mGrading, mNumbering, ranges);
        const Visit whole(mVisits);
        const auto cut = [&](tbb::flow_control& flow) -> TileRange {
            const Visit task(mVisits);
            if (!units.done() && !mInterrupt.stopped()) return units.next();
            flow.stop();
            return {};
        };
        const auto order =
            mSink.concurrent() ? tbb::filter_mode::parallel : tbb::filter_mode::serial_in_order;
        const size_t tokens = 2 * size_t(tbb::this_task_arena::max_concurrency());
        tbb::parallel_pipeline(
            tokens, tbb::make_filter<void, TileRange>(tbb::filter_mode::serial_in_order, cut) &
                        tbb::make_filter<TileRange, Parcel*>(
                            tbb::filter_mode::parallel, [&](const TileRange& unit) { return make(unit); }) &
                        tbb::make_filter<Parcel*, void>(order, [&](Parcel* parcel) { pass(*parcel); }));
    }

private:
    std::int64_t pointsBefore(const Place& at) const {
        return mNumbering.firstPoint[at.span] + mNumbering.runPoints * at.offset;
    }
    std::int64_t tetsBefore(const Place& at) const {
        return mNumbering.firstTet[at.span] + mNumbering.runTets * at.offset;
    }

    Parcel* make(const TileRange& unit) {
        const Visit task(mVisits);
        Parcel* parcel = nullptr;
        if (!mSpare.try_pop(parcel)) parcel = mParcels.push_back(std::make_unique<Parcel>(mWants))->get();
        MeshChunk& chunk = parcel->chunk;
        chunk.firstPoint = pointsBefore(unit.begin);
        chunk.firstTet = tetsBefore(unit.begin);
        const auto points = std::size_t(pointsBefore(unit.end) - chunk.firstPoint),
                   tets = std::size_t(tetsBefore(unit.end) - chunk.firstTet);
        chunk.firstTriangle = mNumbering.firstTriangle[unit.begin.span]; // a run has none
        ChunkBoundary& boundary = parcel->boundary;
        boundary.clear();
        TetShapes& shapes = parcel->shapes;
        shapes.clear();
        ChunkMemory memory = mSink.memory(chunk.firstPoint, chunk.firstTet);
        // Memory that is not aligned to a tet's half takes plain stores.
        bool streaming = reinterpret_cast<std::uintptr_t>(memory.tets) % 16 == 0;
        if (!memory.points || !memory.tets) {
            memory = parcel->memory(points, tets);
            streaming = false;
        }
        Output out{memory.points, memory.tets, mWants.triangles ? &boundary : nullptr,
                   shapes.wanted() ? &shapes : nullptr, streaming};
        TileEmitter& emitter = *mEmitters.local();
        for (Place at = unit.begin; at.span != unit.end.span || at.offset != unit.end.offset;) {
            const Located span = locate(mNumbering, at.span);
            out = emitter.emit(span.tier, span.span, at.offset, out);
            if (++at.offset == mGrading.tiers[span.tier].spans[span.span].count) at = {at.span + 1, 0};
        }
        if (streaming) drainStores();
        chunk.points = {memory.points, points};
        chunk.tets = {memory.tets, tets};
        chunk.triangles = {boundary.triangles.data(), boundary.triangles.size()};
        chunk.surfacePoints = {boundary.points.data(), boundary.points.size()};
        chunk.centroids = {shapes.centroids().data(), shapes.centroids().size()};
        chunk.minDihedrals = {shapes.minDihedrals().data(), shapes.minDihedrals().size()};
        return parcel;
    }

    void pass(Parcel& parcel) {
        const Visit task(mVisits);
        if (mInterrupt.poll(int(100.0 * double(mPassed) / double(mNumbering.tets())))) return;
        mSink.chunk(parcel.chunk);
        mPassed += std::int64_t(parcel.chunk.tets.size());
        mSpare.push(&parcel);
    }

    const Grading& mGrading;
    const Numbering& mNumbering;
    Emitters& mEmitters;
    MeshSink& mSink;
    Interrupt& mInterrupt;
    const MeshWants mWants;
    std::atomic<std::int64_t> mPassed{0}; ///< tets the sink has got
    std::atomic<std::uint64_t> mVisits{0};
    tbb::concurrent_vector<std::unique_ptr<Parcel>> mParcels; ///< all, wherever an exception leaves them
    tbb::concurrent_queue<Parcel*> mSpare;
};

} // namespace

AngleSum emitMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                  const Numbering& numbering, const Frame& frame, const std::vector<TileRange>& ranges,
                  MeshSink& sink, Interrupt& interrupt) {
    Emitters emitters(
        [&] { return std::make_unique<TileEmitter>(vertices, flips, grading, numbering, frame); });
    Emission(grading, numbering, emitters, sink, interrupt).run(ranges);
    return sumOf(emitters, numbering);
}

AngleSum measureMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                     const Numbering& numbering, const Frame& frame, Interrupt& interrupt,
                     const OtherParts* others) {
    Emitters emitters(
        [&] { return std::make_unique<TileEmitter>(vertices, flips, grading, numbering, frame); });
    // Surface tiles are in the first tier.
    interrupt.expectLoops(1);
    const Spans& spans = grading.tiers[0].spans;
    parallelRanges(spans.size(), interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t span = begin; span < end; ++span) {
            if (!others || others->isOwn(0, spans[span])) emitters.local()->measure(0, span);
        }
    });
    return sumOf(emitters, numbering);
}

} // namespace vdbtet
