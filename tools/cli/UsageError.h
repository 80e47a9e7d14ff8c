/// @file UsageError.h
/// What is thrown where the command line makes no sense.
#pragma once

#include <stdexcept>

/// Exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};
