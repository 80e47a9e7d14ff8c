/// @file Reporter.cc
/// A few messages a second.
#include "process/Reporter.h"

#include "process/Signals.h"

void Reporter::start(const char* name) {
    if (mDepth++ > 0) return;
    mStage = name ? name : "";
    tell(0);
}

bool Reporter::wasInterrupted(int percent) {
    constexpr Clock::duration kPause = std::chrono::milliseconds(100);
    const Clock::rep now = Clock::now().time_since_epoch().count();
    Clock::rep next = mNext.load(std::memory_order_relaxed);
    if (mDepth == 1 && now >= next && mNext.compare_exchange_strong(next, now + kPause.count()))
        tell(percent);
    return Signals::first() != 0;
}

void Reporter::tell(int percent) {
    mChannel.send({{"stage", mStage}, {"percent", percent}, {"tets", mTets.load()}});
}
