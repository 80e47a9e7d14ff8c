/// @file Progress.h
/// How far the work is, in one number and one line.
#pragma once

#include "CommandLine.h"

#include <cstdint>
#include <map>
#include <string>

/// @brief How far a job is, from its stages.
/// @details Each stage has a share of the work, roughly what it takes on a level set of 256 voxels across: no
/// one knows, before it is counted, how much of a mesh is inside.
class JobProgress {
public:
    explicit JobProgress(const CommandLine& line);

    /// @param percent  of the stage, or -1 where no one knows
    /// @param tets     so far
    void update(const std::string& stage, int percent, std::int64_t tets);

    const std::string& stage() const { return mStage; }
    /// From 0 to 1; never falls.
    double fraction() const { return mFraction; }
    std::int64_t tets() const { return mTets; }

private:
    struct Share {
        double before, own;
    };
    std::map<std::string, Share> mShares;
    double mAll = 0.0;
    std::string mStage;
    double mFraction = 0.0;
    std::int64_t mTets = 0;
};

/// All of the work at one time.
struct Overview {
    std::size_t jobs = 1, done = 0, failed = 0, running = 0;
    double fraction = 0.0; ///< of the work
    std::int64_t tets = 0;
    double seconds = 0.0; ///< since the start
    std::string stage;    ///< of the only job that runs, or empty
};

/// Such as "12 of 24 done, 1 failed, 2 running, 52 %, 3.4 M tets/s, 1:20 left".
std::string progressText(const Overview& overview);

/// @brief Shows it on standard error.
/// @details On a terminal one line that changes; elsewhere a line now and then, so that short runs have none.
class ProgressDisplay {
public:
    enum class Mode { None, Live, Lines };

    /// Live on a terminal that can clear a line.
    static Mode modeOf(bool quiet);
    explicit ProgressDisplay(Mode mode) : mMode(mode) {}
    ~ProgressDisplay() { clear(); }
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// As often as you like: it shows what is due.
    void show(const Overview& overview);
    /// @return whether a display in that mode that was last changed then is to change now; seconds
    static bool isDue(Mode mode, double last, double now);
    /// Make way for other lines.
    void clear();

private:
    const Mode mMode;
    double mLast = 0.0;
    bool mShown = false;
};
