/// @file Progress.cc
/// Shares of stages, and a line on the terminal.
#include "batch/Progress.h"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

/// Such as 0:07 or 1:02:03.
std::string clockText(double seconds) {
    const auto all = std::int64_t(std::ceil(seconds));
    const std::int64_t hours = all / 3600, minutes = all / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, all % 60)
                     : fmt::format("{}:{:02}", minutes, all % 60);
}

std::string rateText(double rate) {
    if (rate >= 1e6) return fmt::format("{:.1f} M tets/s", rate / 1e6);
    if (rate >= 1e3) return fmt::format("{:.1f} k tets/s", rate / 1e3);
    return fmt::format("{:.0f} tets/s", rate);
}

int terminalWidth() {
    struct winsize size = {};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

} // namespace

JobProgress::JobProgress(const CommandLine& line) {
    const bool uniform = !line.options.grade;
    const bool compressed = line.formatOptions.compression > 0;
    const std::vector<std::pair<const char*, double>> shares = {
        {"read", 20},
        {"fields", line.hasFields() ? 60 : 0},
        {"scan", 5},
        {"tiles", 12},
        {"cuts", 40},
        {"layout", 2},
        {"labels", 3},
        {"destinations", 25},
        {"flips", 15},
        {"repair", 15},
        {"optimize", line.options.optimize ? 250 : 0},
        {"grading", uniform ? 1 : 10},
        {"numbering", 20},
        {"begin", 2},
        {"measure", line.dryRun ? 50 : 0},
        {"emit", line.dryRun ? 0 : (uniform ? 400 : 80) * (compressed ? 10 : 1)},
        {"end", 2}};
    for (const auto& [stage, share] : shares) {
        mShares[stage] = {mAll, share};
        mAll += share;
    }
}

void JobProgress::update(const std::string& stage, int percent, std::int64_t tets) {
    mStage = stage;
    mTets = std::max(mTets, tets);
    const auto share = mShares.find(stage);
    if (share == mShares.end()) return;
    const double part = std::clamp(percent, 0, 100) / 100.0;
    mFraction = std::max(mFraction, (share->second.before + part * share->second.own) / mAll);
}

std::string progressText(const Overview& overview) {
    std::string text;
    if (overview.jobs > 1) {
        text = fmt::format("{} of {} done, ", overview.done, overview.jobs);
        if (overview.failed > 0) text += fmt::format("{} failed, ", overview.failed);
        text += fmt::format("{} running, ", overview.running);
    } else if (!overview.stage.empty()) {
        text = overview.stage + ", ";
    }
    text += fmt::format("{:.0f} %", std::floor(100.0 * overview.fraction));
    if (overview.tets > 0 && overview.seconds > 0.0)
        text += ", " + rateText(double(overview.tets) / overview.seconds);
    // Before that a guess is worth nothing.
    if (overview.fraction >= 0.02 && overview.fraction < 1.0 && overview.seconds >= 1.0)
        text += ", " + clockText(overview.seconds * (1.0 / overview.fraction - 1.0)) + " left";
    return text;
}

ProgressDisplay::Mode ProgressDisplay::modeOf(bool quiet) {
    if (quiet) return Mode::None;
    const char* terminal = std::getenv("TERM");
    const bool canClear = terminal && *terminal != '\0' && std::string(terminal) != "dumb";
    return ::isatty(STDERR_FILENO) == 1 && canClear ? Mode::Live : Mode::Lines;
}

bool ProgressDisplay::isDue(Mode mode, double last, double now) {
    return mode != Mode::None && now - last >= (mode == Mode::Live ? 0.1 : 10.0);
}

void ProgressDisplay::show(const Overview& overview) {
    if (!isDue(mMode, mLast, overview.seconds)) return;
    mLast = overview.seconds;
    const std::string text = "vdb_tet: " + progressText(overview);
    if (mMode == Mode::Lines) {
        std::fputs((text + "\n").c_str(), stderr);
        return;
    }
    // A line that wraps could not be cleared.
    const auto width = std::size_t(std::max(terminalWidth() - 1, 1));
    std::fputs(("\r\x1b[K" + text.substr(0, width)).c_str(), stderr);
    mShown = true;
}

void ProgressDisplay::clear() {
    if (mShown) std::fputs("\r\x1b[K", stderr);
    mShown = false;
}
