/// @file Outcome.h
/// What became of the jobs, for people.
#pragma once

#include "batch/Plan.h"
#include "process/Worker.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

/// What became of a job.
struct Outcome {
    enum class Status { Waiting, Running, Done, Failed, Skipped, Interrupted };
    Status status = Status::Waiting;
    bool meshWritten = false; ///< though interrupted
    int code = 0;             ///< exit code
    std::string message;      ///< of a failure
    nlohmann::json done;      ///< the message of that name; see MeshJob.h
    double seconds = 0.0;
    std::int64_t peakMemory = 0; ///< bytes
};

/// What to say of a child that has ended without a word.
/// @param label  what its job is called
/// @param stage  that it was in
std::string epitaph(const std::string& label, const std::string& stage, const Worker::End& end);

/// A line a job, and one for all.
std::string outcomeTable(const std::vector<Job>& jobs, const std::vector<Outcome>& outcomes, bool dryRun,
                         double seconds);
