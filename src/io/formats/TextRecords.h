/// @file TextRecords.h
/// Numbers of text formats, padded with spaces on the left to a width that is the same for all records. They
/// do not depend on the locale.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>

namespace vdbtet {

/// Characters that any coordinate fits into.
inline std::size_t coordinateWidth(bool float32) { return float32 ? 15 : 24; }

/// Characters that the ids up to @a largest fit into.
inline std::size_t idWidth(std::int64_t largest) { return std::to_string(largest).size(); }

/// Move the @a size characters at @a to to the right end of @a width.
/// @return where the next number goes
inline char* alignRight(char* to, std::size_t size, std::size_t width) {
    std::copy_backward(to, to + size, to + width);
    std::fill(to, to + (width - size), ' ');
    return to + width;
}

/// Write such a coordinate that a reader gets the very same number: as float32, or as float64.
inline char* putCoordinate(char* to, double value, bool float32) {
    const std::size_t width = coordinateWidth(float32);
    // The shortest text of a float32 may become its neighbour by way of a float64, the one of nine digits
    // does not.
    const auto end = float32 ? std::to_chars(to, to + width, float(value), std::chars_format::general, 9).ptr
                             : std::to_chars(to, to + width, value).ptr;
    return alignRight(to, std::size_t(end - to), width);
}

inline char* putId(char* to, std::int64_t id, std::size_t width) {
    return alignRight(to, std::size_t(std::to_chars(to, to + width, id).ptr - to), width);
}

} // namespace vdbtet
