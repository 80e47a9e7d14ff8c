/// @file Errors.h
/// The exceptions of vdbtet. Each message says what was wrong, with which grid or file, and what to do.
#pragma once

#include <exception>
#include <string>
#include <utility>

namespace vdbtet {

/// Base of everything this library throws on purpose.
class Error : public std::exception {
public:
    explicit Error(std::string message) : mMessage(std::move(message)) {}

    const char* what() const noexcept override { return mMessage.c_str(); }

    /// Say what the message is about, in front of it.
    void prefix(const std::string& subject) { mMessage = subject + ": " + mMessage; }

private:
    std::string mMessage;
};

/// An option is out of its range, or two options contradict each other.
struct BadOption : Error {
    using Error::Error;
};

/// The grid cannot be meshed at all: not a float or double grid, a frustum or singular transform.
struct UnsupportedGrid : Error {
    using Error::Error;
};

/// The grid holds values that have no sign: NaN or infinite.
struct BadValue : Error {
    using Error::Error;
};

/// No value crosses the isovalue, so there is no inside.
struct NoSurface : Error {
    using Error::Error;
};

/// The background, or a region without end, lies inside.
struct UnboundedInside : Error {
    using Error::Error;
};

/// The mesh would exceed a limit of Options or the precision of its coordinates.
struct TooLarge : Error {
    using Error::Error;
};

/// A file could not be read or written.
struct FileError : Error {
    using Error::Error;
};

} // namespace vdbtet
