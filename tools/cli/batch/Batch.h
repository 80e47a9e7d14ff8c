/// @file Batch.h
/// Does all jobs, each in a child process, some at once.
///
/// Why processes: OpenVDB may crash on a damaged file, and reading one cannot be stopped; a child can be
/// killed, its memory is what it took, and what it did not finish leaves nothing.
#pragma once

#include "batch/JobLog.h"
#include "batch/Outcome.h"
#include "batch/Plan.h"
#include "batch/Progress.h"
#include "process/Signals.h"
#include "process/Worker.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class Batch {
public:
    Batch(const CommandLine& line, std::vector<Job> jobs, const Signals& signals);

    /// @return the exit code
    int run();

private:
    using Clock = std::chrono::steady_clock;

    /// A job in its process.
    struct Running {
        std::size_t index;
        JobProgress progress;
        Clock::time_point start;
        nlohmann::json last; ///< its message at the end
        Worker worker;
    };

    void skipDone();
    void startJobs();
    void start(std::size_t index, int threads);
    int mostAtOnce() const;
    void wait();
    void passSignalsOn();
    void finish(Running& running);
    void failed(std::size_t index, int code, const std::string& message);
    void warn(std::size_t index, const std::string& message);
    Overview overview() const;
    int exitCode() const;
    void log(const char* event, std::size_t index, const nlohmann::ordered_json& details);
    double seconds() const { return std::chrono::duration<double>(Clock::now() - mStart).count(); }

    const CommandLine& mLine;
    const std::vector<Job> mJobs;
    const Signals& mSignals;
    JobLog mLog;
    ProgressDisplay mDisplay;
    const int mThreads; ///< for all
    const Clock::time_point mStart = Clock::now();

    std::vector<Outcome> mOutcomes;
    std::vector<std::unique_ptr<Running>> mRunning;
    std::size_t mNext = 0; ///< the first job that has not been started
    int mFitting = 1;      ///< how many jobs are let run at once, by memory
    std::int64_t mPeak = 0, mFree = 0;
    std::int64_t mTetsDone = 0;
    bool mLogFailed = false;
    std::optional<Clock::time_point> mKillAt; ///< once a signal has come
};
