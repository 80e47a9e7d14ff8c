/// @file Search.h
/// Branch and bound: a problem's domain is halved until each part is proved.
#pragma once

#include "Judge.h"

#include <cstdint>
#include <optional>

namespace vdbtet::proof {

/// A box that no proof was found for.
struct Failure {
    Box box;
    bool violated; ///< at all of its points; or it is too small to be halved again
};

/// @brief What a problem attains, as far as the points that the proof came by and a climb from the best of
/// them tell.
/// @details In plain doubles: it tells how much room a bound leaves, and no proof needs it.
struct Extremes {
    double min = 180.0, max = 0.0; ///< degrees, or radii
    Point minAt{}, maxAt{};
};

struct Result {
    std::optional<Failure> failure;
    Extremes extremes;      ///< so far, if it failed
    std::int64_t boxes = 0; ///< looked at
};

/// Prove the problem's bound, or find where it fails.
Result prove(const Problem& problem, const Limits& limits);

/// The least and the greatest angle in degrees, or the radius as both.
struct Range {
    double min, max;
};

/// @return the range over the tets of the alternative that is taken at a point, or nothing where a condition
/// is not met.
std::optional<Range> rangeAt(const Problem& problem, const Point& point, bool ofRadius);

} // namespace vdbtet::proof
