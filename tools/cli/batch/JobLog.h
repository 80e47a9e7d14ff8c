/// @file JobLog.h
/// What becomes of the jobs, for programs: a line of JSON for each event.
#pragma once

#include "batch/Plan.h"

#include <nlohmann/json.hpp>

#include <string>

/// @brief Appends to a file. Each line is one write, so the lines there are whole whatever becomes of us.
/// @details Lines have "event" (start, end, fail, skip), "time" (UTC), "job" (from 1), "input", "grid",
/// "frame" and "output", these where they are known, and what the event has besides.
class JobLog {
public:
    /// @param path  empty for no log
    /// @throw vdbtet::FileError where the file cannot be opened
    explicit JobLog(const std::string& path);
    ~JobLog();
    JobLog(const JobLog&) = delete;
    JobLog& operator=(const JobLog&) = delete;

    /// @param details  an object
    /// @return false the first time that the log cannot be written; the work goes on without it
    bool add(const char* event, const Job& job, std::size_t index, const nlohmann::ordered_json& details);

private:
    int mFd = -1;
};
