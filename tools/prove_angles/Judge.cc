/// @file Judge.cc
/// Bounds of cosines, volumes and radii on boxes.
#include "Judge.h"

#include <limits>
#include <stdexcept>

namespace vdbtet::proof {

namespace {

/// What is bounded of a tet: the cosine at an edge, 0 to 5, the volume, or the radius.
constexpr int kVolume = 6, kRadius = 7;

template <typename T>
T valueOf(const Tet& tet, int what, const Values<T>& p) {
    const Corners<T> corners = cornersOf(tet, p);
    if (what == kVolume) return volume6(corners);
    if (what == kRadius) return squaredRadius(corners);
    return cosineBetween(normal(corners, kEdgeFaces[what][0]), normal(corners, kEdgeFaces[what][1]));
}

/// Whether a value lies strictly between two limits, each of which is an interval itself.
Verdict within(const Interval& value, const Interval& low, const Interval& high) {
    if (value.lower() > low.upper() && value.upper() < high.lower()) return Verdict::Holds;
    if (value.upper() <= low.lower() || value.lower() >= high.upper()) return Verdict::Violated;
    return Verdict::Unknown;
}

/// @brief The range of a value on a box, from its slopes there.
/// @details Along a parameter whose slope has one sign the extreme is at an end of the range; for the others
/// the mean value theorem bounds what is lost by looking at their midpoint alone.
Interval rangeOf(const Tet& tet, int what, const Values<Interval>& slope, const Box& box) {
    Interval ends[2];
    for (int side = 0; side < 2; ++side) {
        Box at = box;
        Interval rest(0.0);
        for (int p = 0; p < kParameters; ++p) {
            const bool rises = slope[p].lower() >= 0.0, falls = slope[p].upper() <= 0.0;
            if (rises || falls) {
                at[p] = rises == (side == 1) ? box[p].upper() : box[p].lower();
            } else {
                at[p] = median(box[p]);
                rest += slope[p] * (box[p] - at[p]);
            }
        }
        ends[side] = valueOf(tet, what, at) + rest;
    }
    return {ends[0].lower(), ends[1].upper()};
}

bool isPoint(const Box& box) {
    for (const Interval& side : box) {
        if (side.lower() != side.upper()) return false;
    }
    return true;
}

} // namespace

Limits::Limits(const Bound& bound)
    : minCosine(cosineOfDegrees(enclose(bound.max))), maxCosine(cosineOfDegrees(enclose(bound.min))),
      squaredRadius(square(enclose(bound.radius))), isRadius(bound.radius != 0.0) {}

Judge::Judge(const Problem& problem, const Limits& limits) : mProblem(problem), mLimits(limits) {
    const int first = limits.isRadius ? kRadius : 0, last = limits.isRadius ? kRadius : kVolume;
    for (std::size_t i = 0; i < problem.alternatives.size(); ++i) {
        for (const Tet& tet : problem.alternatives[i]) {
            for (int what = first; what <= last; ++what) mChecks.push_back({&tet, what, i});
        }
    }
    if (mChecks.size() > kMaxChecks) throw std::length_error("more checks than a part of a problem has bits");
}

Verdict Judge::compare(const Interval& value, int what) const {
    if (what == kVolume) return within(value, 0.0, std::numeric_limits<double>::max());
    if (what == kRadius) return within(value, -1.0, mLimits.squaredRadius);
    return within(value, mLimits.minCosine, mLimits.maxCosine);
}

/// Bound the check by its slopes.
Verdict Judge::refine(const Check& check, const Box& box) const {
    const Values<Interval> slope = valueOf(*check.tet, check.what, jetsOf(box)).slope;
    return compare(rangeOf(*check.tet, check.what, slope, box), check.what);
}

/// Unknown if the box has points that may be none of the problem's, Violated if all are.
Verdict Judge::meetsConditions(const Box& box) const {
    Verdict verdict = Verdict::Holds;
    for (const Condition& condition : mProblem.conditions) {
        const Interval value = condition.on(box);
        if (value.upper() < 0.0) return Verdict::Violated;
        if (!(value.lower() >= 0.0)) verdict = Verdict::Unknown;
    }
    return verdict;
}

/// One alternative: its checks are those from @a first to @a end.
Verdict Judge::judgeAlternative(std::size_t first, std::size_t end, Part& part) const {
    for (std::size_t i = first; i < end; ++i) {
        if (part.violated[i]) return Verdict::Violated;
    }
    for (std::size_t i = first; i < end; ++i) {
        if (part.proved[i]) continue;
        const Verdict verdict = compare(valueOf(*mChecks[i].tet, mChecks[i].what, part.box), mChecks[i].what);
        if (verdict == Verdict::Holds) part.proved.set(i);
        if (verdict == Verdict::Violated) part.violated.set(i);
        if (verdict == Verdict::Violated) return verdict;
    }
    // The first check that fails now is the first one tried again on the parts of this box.
    const bool point = isPoint(part.box);
    for (std::size_t i = first; i < end; ++i) {
        if (part.proved[i]) continue;
        if (point || refine(mChecks[i], part.box) != Verdict::Holds) return Verdict::Unknown;
        part.proved.set(i);
    }
    return Verdict::Holds;
}

Verdict Judge::operator()(Part& part) const {
    const Verdict met = meetsConditions(part.box);
    if (met == Verdict::Violated) return Verdict::Holds; // of none of its points anything is to be proved
    bool allViolated = met == Verdict::Holds;
    for (std::size_t first = 0, end = 0; first < mChecks.size(); first = end) {
        while (end < mChecks.size() && mChecks[end].alternative == mChecks[first].alternative) ++end;
        const Verdict verdict = judgeAlternative(first, end, part);
        if (verdict == Verdict::Holds) return verdict;
        allViolated = allViolated && verdict == Verdict::Violated;
    }
    return allViolated ? Verdict::Violated : Verdict::Unknown;
}

} // namespace vdbtet::proof
