/// @file Parallel.h
/// Parallel loops that stop when the user says so.
#pragma once

#include <openvdb/util/NullInterrupter.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdint>

namespace vdbtet {

/// @brief The user's interrupter, which may be null, and whether it ever said stop.
/// @details Counts how far a stage is, so that the interrupter's host can show it.
class Interrupt {
public:
    explicit Interrupt(openvdb::util::NullInterrupter* interrupter) : mInterrupter(interrupter) {}

    /// Ask the interrupter; from the first yes on the answer stays yes.
    /// @param percent  of the stage's work that is done, or -1 where no one knows
    bool poll(int percent = -1) {
        if (mInterrupter && !mStopped && mInterrupter->wasInterrupted(percent)) mStopped = true;
        return mStopped;
    }
    bool stopped() const { return mStopped; }

    /// Stages follow one another, and do not nest.
    void startStage(const char* name) {
        mLoops = mLoop = 0;
        if (mInterrupter) mInterrupter->start(name);
    }
    void endStage() {
        if (mInterrupter) mInterrupter->end();
    }

    /// Say, in a stage, that the next @a loops loops over ranges are its work, in parts that are about
    /// equal. Nothing is known of the loops of a stage that does not say so, nor of those after these.
    void expectLoops(int loops) {
        mLoops = loops;
        mLoop = 0;
    }

    /// A loop of the stage, and how far it is.
    class Loop {
    public:
        Loop(Interrupt& interrupt, std::int64_t count)
            : mCount(count), mIndex(interrupt.mLoop++), mLoops(interrupt.mLoops) {}

        void add(std::int64_t items) { mDone.fetch_add(items, std::memory_order_relaxed); }
        int percent() const {
            if (mIndex >= mLoops) return -1;
            const double part = double(mDone.load(std::memory_order_relaxed)) / double(mCount);
            return int(100.0 * (mIndex + part) / mLoops);
        }

    private:
        const std::int64_t mCount;
        const int mIndex, mLoops;
        std::atomic<std::int64_t> mDone{0};
    };

private:
    openvdb::util::NullInterrupter* mInterrupter;
    std::atomic<bool> mStopped{false};
    int mLoops = 0, mLoop = 0;
};

/// @brief Call @a body(begin, end) in parallel on ranges that make up [0, count), asking the interrupter once
/// a range.
/// @details After a stop the remaining ranges are skipped and the product is useless; the pipeline checks
/// stopped().
template <typename Body>
void parallelRanges(std::int64_t count, Interrupt& interrupt, Body&& body) {
    constexpr std::int64_t kGrain = 32;
    Interrupt::Loop loop(interrupt, count);
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, kGrain),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                          if (interrupt.poll(loop.percent())) return;
                          body(range.begin(), range.end());
                          loop.add(range.end() - range.begin());
                      });
}

/// The same for few and heavy items: call @a body(i) for each.
template <typename Body>
void parallelEach(std::int64_t count, Interrupt& interrupt, Body&& body) {
    tbb::parallel_for(std::int64_t(0), count, [&](std::int64_t i) {
        if (!interrupt.poll()) body(i);
    });
}

} // namespace vdbtet
