/// @file Plan.h
/// From what the command line says to the jobs to do.
#pragma once

#include "CommandLine.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// One grid of one file to mesh.
struct Job {
    CommandLine line;                 ///< names of one file each, without placeholders
    std::optional<std::string> frame; ///< its number, padded
    std::string error;                ///< why it cannot be done, where that is known already

    /// What it is called in messages.
    std::string label() const;
    /// All files it writes.
    std::vector<std::string> outputs() const;
};

/// @return the names of a file's grids that can be meshed, for --all-grids
/// @throw std::exception
using ListGrids = std::function<std::vector<std::string>(const std::string& path)>;

/// @brief Fill in placeholders, and see that no file is written twice, or over one that is read.
/// @return at least one job, in the order of files, frames and grids
/// @throw UsageError
std::vector<Job> planJobs(const CommandLine& line, const ListGrids& listGrids);

/// @return whether all outputs are there, and newer than all that the job reads
bool isUpToDate(const Job& job);
