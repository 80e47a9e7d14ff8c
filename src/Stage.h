/// @file Stage.h
/// What is alike in all stages of a run.
#pragma once

#include "Parallel.h"

#include <vdbtet/VolumeToTets.h>

#include <chrono>

namespace vdbtet {

/// @brief Do one stage's @a work(): tell the interrupter, take the time, and see whether to go on.
/// @return what it returns; useless where Report::cancelled is set
template <typename Work>
auto runStage(const char* name, Interrupt& interrupt, Report& report, const Work& work) {
    struct Session {
        Session(const char* stage, Interrupt& host) : mHost(host) { mHost.startStage(stage); }
        ~Session() { mHost.endStage(); }
        Interrupt& mHost;
    };
    const Session session(name, interrupt);
    const auto start = std::chrono::steady_clock::now();
    auto product = work();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    report.stages.push_back({name, elapsed.count()});
    report.cancelled = interrupt.poll();
    return product;
}

} // namespace vdbtet
