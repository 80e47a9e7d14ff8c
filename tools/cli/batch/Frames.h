/// @file Frames.h
/// Sequences of files: lists of frames, names with a place for the frame's number, names with placeholders.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// @brief Read a list of frames, such as "1-240x2,300": each item is a frame, a range, or a range in steps.
/// @return the frames in the order of the list, each once
/// @throw UsageError
std::vector<std::int64_t> parseFrames(const std::string& list);

/// A path whose file name has a place for a frame's number: %d, %04d, or ####, a digit each.
class FramePattern {
public:
    /// @return nothing where there is no such place; the last one counts
    static std::optional<FramePattern> find(const std::string& path);

    /// @return the frame's number, padded
    std::string number(std::int64_t frame) const;
    std::string path(const std::string& number) const { return mBefore + number + mAfter; }

private:
    std::string mBefore, mAfter;
    int mDigits = 1;
};

/// What placeholders stand for.
struct Placeholders {
    std::string stem;                 ///< the input's name without folders and extension
    std::optional<std::string> frame; ///< its number, padded as in the input's name
    std::optional<std::string> grid;
};

/// @return the last run of digits of a name
std::optional<std::string> lastNumber(const std::string& name);

/// @brief Replace {stem}, {frame} and {grid}.
/// @param option  whose value the pattern is, for the message
/// @throw UsageError where it is not known what one stands for
std::string fillIn(const std::string& pattern, const Placeholders& values, const std::string& option);
