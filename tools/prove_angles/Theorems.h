/// @file Theorems.h
/// The bounds that are proved, and what a proof tells.
#pragma once

#include "Search.h"

#include <functional>
#include <string>
#include <vector>

namespace vdbtet::proof {

struct Theorem {
    std::string id; ///< the paper's equation or section
    std::string what;
    Bound bound;
    std::function<std::vector<Problem>()> problems;
};

/// All of them, with the bounds that hold.
const std::vector<Theorem>& theorems();

/// An extreme and the problem that attains it.
struct Attained {
    double value = 0.0; ///< degrees, or a radius
    std::string name;
    Point at{};
};

struct Proof {
    bool proved = false;
    std::string obstacle; ///< one line, if it is not
    std::size_t kinds = 0;
    std::int64_t configurations = 0; ///< of those kinds
    std::int64_t boxes = 0;
    std::vector<Attained> least, greatest; ///< the kinds that attain the extremes, to 1e-4
};

/// @brief Prove a theorem with a bound, on all threads; the same on any number of them.
/// @details Where Algorithm 4 chooses among n slices, it is enough that one slice is good. Let t be the
/// policy's angle (kMinAngle) and d its tolerance (kTieAngle). If the angles of one slice lie in (t + (n-1)
/// d, max - (n-1) d), then those of the chosen one lie in (t - (n-2) d, max): against a slice whose least
/// angle is above t too it loses only to a lesser greatest angle, and against any other it wins; and a tie
/// costs d at most.
Proof proveTheorem(const Theorem& theorem, const Bound& bound);

} // namespace vdbtet::proof
