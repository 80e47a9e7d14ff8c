/// @file Batch.cc
/// One loop that waits for children, signals and time.
#include "batch/Batch.h"

#include "Console.h"
#include "batch/Memory.h"
#include "process/MeshJob.h"

#include <vdbtet/Errors.h>

#include "io/OutputFile.h"

#include <fmt/format.h>

#include <poll.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace {

using Status = Outcome::Status;

/// How long children have to stop by themselves.
constexpr std::chrono::milliseconds kGrace(700);

int threadsOf(const CommandLine& line) {
    return line.threads > 0 ? line.threads : int(std::max(1u, std::thread::hardware_concurrency()));
}

} // namespace

Batch::Batch(const CommandLine& line, std::vector<Job> jobs, const Signals& signals)
    : mLine(line), mJobs(std::move(jobs)), mSignals(signals), mLog(line.log),
      mDisplay(ProgressDisplay::modeOf(line.quiet)), mThreads(threadsOf(line)), mOutcomes(mJobs.size()) {}

int Batch::run() {
    if (mLine.resume) skipDone();
    for (;;) {
        mSignals.check();
        passSignalsOn();
        startJobs();
        if (mRunning.empty()) break;
        wait();
        mDisplay.show(overview());
    }
    mDisplay.clear();
    if (mJobs.size() > 1) {
        if (!mLine.quiet) print(outcomeTable(mJobs, mOutcomes, mLine.dryRun, seconds()));
    } else if (mOutcomes[0].status == Status::Skipped) {
        if (!mLine.quiet) print(mJobs[0].line.in + ": skipped, as its outputs are newer\n");
    } else if (mOutcomes[0].status == Status::Done && !mLine.quiet) {
        print(mOutcomes[0].done["text"]);
    }
    if (exitCode() > 128) {
        const auto written = std::count_if(mOutcomes.begin(), mOutcomes.end(),
                                           [](const Outcome& one) { return one.status == Status::Done; });
        complain(mJobs.size() == 1 && mOutcomes[0].meshWritten
                     ? "interrupted; the mesh is written, the report is not"
                 : mJobs.size() == 1
                     ? "interrupted; nothing was written"
                     : fmt::format("interrupted; {} of {} are done, and --resume does the others", written,
                                   mJobs.size()));
    }
    return exitCode();
}

void Batch::skipDone() {
    for (std::size_t i = 0; i < mJobs.size(); ++i) {
        if (!mJobs[i].error.empty() || !isUpToDate(mJobs[i])) continue;
        mOutcomes[i].status = Status::Skipped;
        log("skip", i, {{"reason", "the outputs are newer than the input"}});
    }
}

int Batch::mostAtOnce() const {
    if (mLine.jobs > 0) return mLine.jobs;
    return mFitting;
}

void Batch::startJobs() {
    for (; mNext < mJobs.size() && !mKillAt; ++mNext) {
        if (mOutcomes[mNext].status == Status::Skipped) continue;
        if (int(mRunning.size()) >= mostAtOnce()) return;
        if (!mJobs[mNext].error.empty()) {
            failed(mNext, 1, mJobs[mNext].error);
            continue;
        }
        std::size_t left = mRunning.size();
        for (std::size_t i = mNext; i < mJobs.size(); ++i)
            left += mOutcomes[i].status == Status::Waiting ? 1 : 0;
        const int share = std::max(1, mThreads / int(std::min(left, std::size_t(mostAtOnce()))));
        // All threads are what the library takes by itself.
        start(mNext, share == mThreads ? mLine.threads : share);
    }
}

void Batch::start(std::size_t index, int threads) {
    const Job& job = mJobs[index];
    CommandLine line = job.line;
    line.threads = threads;
    log("start", index, nlohmann::ordered_json::object());
    try {
        mRunning.push_back(std::unique_ptr<Running>(
            new Running{index, JobProgress(line), Clock::now(), {}, {mSignals, [&](const Channel& channel) {
                                                                         return meshJob(line, channel);
                                                                     }}}));
        mOutcomes[index].status = Status::Running;
    } catch (const std::system_error& error) {
        failed(index, 1, job.label() + ": " + error.what());
    }
}

void Batch::wait() {
    std::vector<pollfd> files;
    for (const auto& running : mRunning) files.push_back({running->worker.fd(), POLLIN, 0});
    const struct timespec pause = {0, 100000000}; // so that the display changes, and the grace ends
    const int ready = ::ppoll(files.data(), files.size(), &pause, &mSignals.whileWaiting());
    mSignals.check(); // before a child that it has stopped, too, is taken for one that stopped by itself
    if (ready <= 0) return;
    for (std::size_t i = files.size(); i-- > 0;) {
        if (files[i].revents == 0) continue;
        Running& running = *mRunning[i];
        const bool goesOn = running.worker.receive([&](const nlohmann::json& message) {
            if (message.contains("stage"))
                running.progress.update(message["stage"], message["percent"], message["tets"]);
            else if (message.contains("warning"))
                warn(running.index, message["warning"]);
            else
                running.last = message;
        });
        if (goesOn) continue;
        finish(running);
        mRunning.erase(mRunning.begin() + std::ptrdiff_t(i));
    }
}

void Batch::passSignalsOn() {
    if (mSignals.count() == 0) return;
    if (!mKillAt) {
        mKillAt = Clock::now() + kGrace;
        for (const auto& running : mRunning) running->worker.signal(mSignals.first());
    }
    // Reading a file cannot be stopped otherwise.
    if (mSignals.count() > 1 || Clock::now() >= *mKillAt) {
        for (const auto& running : mRunning) running->worker.signal(SIGKILL);
    }
}

void Batch::finish(Running& running) {
    const Worker::End& end = running.worker.end();
    const Job& job = mJobs[running.index];
    Outcome& outcome = mOutcomes[running.index];
    outcome.seconds = std::chrono::duration<double>(Clock::now() - running.start).count();
    outcome.peakMemory = end.peakMemory;
    mTetsDone += running.progress.tets();
    const nlohmann::json& last = running.last;
    if (last.contains("done")) {
        outcome.status = Status::Done;
        outcome.done = last["done"];
        log("end", running.index,
            {{"points", outcome.done["points"]},
             {"tets", outcome.done["tets"]},
             {"angles", outcome.done["angles"]},
             {"bytes", outcome.done["bytes"]},
             {"seconds", outcome.seconds},
             {"peakMemory", outcome.peakMemory}});
        if (mPeak == 0) mFree = freeMemory().value_or(0);
        if (outcome.peakMemory > mPeak) {
            mPeak = outcome.peakMemory;
            mFitting = jobsThatFit(mFree, mPeak, mThreads);
        }
    } else if (last.contains("error")) {
        failed(running.index, last["code"], last["error"]);
    } else if (mSignals.first() != 0 || last.contains("cancelled")) {
        const int signal = last.contains("cancelled") ? last["cancelled"].get<int>() : mSignals.first();
        outcome.status = Status::Interrupted;
        outcome.meshWritten = last.is_object() && last.value("written", false);
        outcome.code = 128 + signal;
        log("fail", running.index, {{"error", fmt::format("interrupted (signal {})", signal)}});
    } else {
        failed(running.index, 1, epitaph(job.label(), running.progress.stage(), end));
    }
    if (end.signal == 0) return;
    for (const std::string& path : job.outputs()) {
        try {
            vdbtet::OutputFile::removeLeft(path, end.pid);
        } catch (const vdbtet::FileError&) { // there is no such place, and nothing is left
        }
    }
}

void Batch::failed(std::size_t index, int code, const std::string& message) {
    Outcome& outcome = mOutcomes[index];
    outcome.status = Status::Failed;
    outcome.code = code;
    outcome.message = message;
    log("fail", index, {{"error", message}, {"code", code}, {"seconds", outcome.seconds}});
    mDisplay.clear();
    const bool named = mJobs.size() == 1 || message.find(mJobs[index].line.in) != std::string::npos;
    complain(named ? message : mJobs[index].label() + ": " + message);
    if (mLine.failFast) mNext = mJobs.size();
}

Overview Batch::overview() const {
    Overview overview;
    overview.jobs = mJobs.size();
    overview.running = mRunning.size();
    overview.seconds = seconds();
    overview.tets = mTetsDone;
    double work = 0.0, done = 0.0;
    for (const Outcome& outcome : mOutcomes) {
        const bool ended = outcome.status == Status::Done || outcome.status == Status::Failed;
        overview.failed += outcome.status == Status::Failed ? 1 : 0;
        overview.done += ended || outcome.status == Status::Skipped ? 1 : 0;
        work += outcome.status == Status::Skipped ? 0.0 : 1.0;
        done += ended ? 1.0 : 0.0;
    }
    for (const auto& running : mRunning) {
        done += running->progress.fraction();
        overview.tets += running->progress.tets();
        if (mJobs.size() == 1) overview.stage = running->progress.stage();
    }
    overview.fraction = work > 0.0 ? done / work : 1.0;
    return overview;
}

int Batch::exitCode() const {
    if (mJobs.size() == 1) return mOutcomes[0].code;
    const auto any = [&](auto&& is) { return std::any_of(mOutcomes.begin(), mOutcomes.end(), is); };
    const bool isWhole = !any([](const Outcome& one) {
        return one.status == Status::Interrupted || one.status == Status::Waiting;
    });
    if (mSignals.first() != 0 && !isWhole) return 128 + mSignals.first();
    return isWhole && !any([](const Outcome& one) { return one.status == Status::Failed; }) ? 0 : 1;
}

void Batch::warn(std::size_t index, const std::string& message) {
    log("warning", index, {{"warning", message}});
    if (mLine.quiet) return;
    mDisplay.clear();
    complain("warning: " + message);
}

void Batch::log(const char* event, std::size_t index, const nlohmann::ordered_json& details) {
    if (mLog.add(event, mJobs[index], index, details) || mLogFailed) return;
    mLogFailed = true;
    mDisplay.clear();
    complain("cannot write " + mLine.log + ", so there is no log from here on");
}
