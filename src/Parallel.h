/// @file Parallel.h
/// Parallel loops that stop when the user says so.
#pragma once

#include <openvdb/util/NullInterrupter.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdint>

namespace vdbtet {

/// The user's interrupter, which may be null, and whether it ever said stop.
class Interrupt {
public:
    explicit Interrupt(openvdb::util::NullInterrupter* interrupter) : mInterrupter(interrupter) {}

    /// Ask the interrupter; from the first yes on the answer stays yes.
    bool poll(int percent = -1) {
        if (mInterrupter && !mStopped && mInterrupter->wasInterrupted(percent)) mStopped = true;
        return mStopped;
    }
    bool stopped() const { return mStopped; }

private:
    openvdb::util::NullInterrupter* mInterrupter;
    std::atomic<bool> mStopped{false};
};

/// @brief Call @a body(begin, end) in parallel on ranges that make up [0, count), asking the interrupter once
/// a range.
/// @details After a stop the remaining ranges are skipped and the product is useless; the pipeline checks
/// stopped().
template <typename Body>
void parallelRanges(std::int64_t count, Interrupt& interrupt, Body&& body) {
    constexpr std::int64_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, kGrain),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                          if (!interrupt.poll()) body(range.begin(), range.end());
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
