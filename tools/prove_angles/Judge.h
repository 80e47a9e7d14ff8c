/// @file Judge.h
/// Whether tets keep a bound for all parameters of a box.
#pragma once

#include "Problem.h"

#include <bitset>

namespace vdbtet::proof {

enum class Verdict {
    Holds,    ///< at all points of the box
    Violated, ///< at all points of the box
    Unknown
};

/// A bound as what is computed is compared with.
struct Limits {
    explicit Limits(const Bound& bound);

    Interval minCosine, maxCosine; ///< of the largest and of the smallest angle
    Interval squaredRadius;
    bool isRadius;
};

/// @brief Judges boxes of one problem.
/// @details Each cosine, volume or radius is a check. It is bounded by intervals first; then, where these are
/// too wide, by its slopes on the box.
class Judge {
public:
    static constexpr int kMaxChecks = 128;

    Judge(const Problem& problem, const Limits& limits);

    /// A box, and what is known of it from the boxes that it is a part of.
    struct Part {
        Box box;
        std::bitset<kMaxChecks> proved, violated; ///< checks, at all points of the box
    };

    /// @param part  gets the checks that are decided now
    Verdict operator()(Part& part) const;

private:
    struct Check {
        const Tet* tet;
        int what;
        std::size_t alternative;
    };

    Verdict meetsConditions(const Box& box) const;
    Verdict judgeAlternative(std::size_t first, std::size_t end, Part& part) const;
    Verdict refine(const Check& check, const Box& box) const;
    Verdict compare(const Interval& value, int what) const;

    const Problem& mProblem;
    const Limits& mLimits;
    std::vector<Check> mChecks;
};

} // namespace vdbtet::proof
