/// @file Reporter.h
/// Tells the parent how far a job is, and the mesher when to stop.
#pragma once

#include "process/Worker.h"

#include <openvdb/util/NullInterrupter.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

class Reporter final : public openvdb::util::NullInterrupter {
public:
    explicit Reporter(const Channel& channel) : mChannel(channel) {}

    /// OpenVDB's own tools, inside a stage, start and end parts of it: these are not told.
    void start(const char* name = nullptr) override;
    void end() override { --mDepth; }
    /// Says stop once a signal has come.
    bool wasInterrupted(int percent = -1) override;

    void addTets(std::int64_t tets) { mTets += tets; }

private:
    using Clock = std::chrono::steady_clock;

    void tell(int percent);

    const Channel& mChannel;
    int mDepth = 0;
    std::string mStage;
    std::atomic<std::int64_t> mTets{0};
    std::atomic<Clock::rep> mNext{0}; ///< when to tell again
};
