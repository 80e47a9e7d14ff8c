/// @file ReadingLimits.h
/// What reading a file may take at most, so that a damaged one cannot ask for more.
#pragma once

#include <sys/resource.h>

#include <string>

/// @brief While it lives, this process can take neither much more memory nor much longer than a sound file of
/// that size would.
/// @details Memory beyond it is std::bad_alloc, time beyond it ends the process by SIGXCPU. Not under
/// sanitizers, which take more.
class ReadingLimits {
public:
    explicit ReadingLimits(const std::string& path);
    ~ReadingLimits();
    ReadingLimits(const ReadingLimits&) = delete;
    ReadingLimits& operator=(const ReadingLimits&) = delete;

private:
    rlimit mMemory = {}, mTime = {};
};
