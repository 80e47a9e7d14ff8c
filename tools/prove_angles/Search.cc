/// @file Search.cc
/// Depth first, so that few boxes wait.
#include "Search.h"

#include "flips/Slices.h"
#include "quality/Dihedral.h"

#include <algorithm>

namespace vdbtet::proof {

namespace {

constexpr double kSmallest = 0x1p-30; // the widest side of a box that is not halved

int widestSide(const Box& box) {
    int widest = 0;
    for (int p = 1; p < kParameters; ++p) {
        if (width(box[p]) > width(box[widest])) widest = p;
    }
    return widest;
}

Point centreOf(const Box& box) {
    Point centre;
    for (int p = 0; p < kParameters; ++p) centre[p] = median(box[p]);
    return centre;
}

/// Corner number @a n of the domain.
Point cornerOf(const Box& box, int n) {
    Point corner;
    for (int p = 0; p < kParameters; ++p) corner[p] = (n >> p & 1) ? box[p].upper() : box[p].lower();
    return corner;
}

/// A box around a point that violates the bound, all of which does.
Failure around(const Judge& judge, const Box& domain, const Point& point) {
    Judge::Part part;
    for (double half = 0.0625;; half *= 0.5) {
        for (int p = 0; p < kParameters; ++p) {
            part.box[p] = intersect(Interval(point[p] - half, point[p] + half), domain[p]);
        }
        if (half < kSmallest || judge(part) == Verdict::Violated) return {part.box, true};
    }
}

SliceQuality qualityOf(const std::vector<Tet>& tets, const Point& point) {
    SliceQuality quality;
    for (const Tet& tet : tets) {
        const Corners<double> c = cornersOf(tet, point);
        quality.inverted = quality.inverted || volume6(c) <= 0.0;
        for (const auto& faces : kEdgeFaces) {
            const double cosine = cosineBetween(normal(c, faces[0]), normal(c, faces[1]));
            quality.minCos = std::min(quality.minCos, cosine);
            quality.maxCos = std::max(quality.maxCos, cosine);
        }
    }
    return quality;
}

/// Version 3's measure of a slice.
double version3Quality(const SliceQuality& q) {
    return q.inverted ? 0.0 : std::min(angleOf(q.maxCos), 0.54 * (180.0 - angleOf(q.minCos)));
}

} // namespace

std::optional<Range> rangeAt(const Problem& problem, const Point& point, bool ofRadius) {
    for (const Condition& condition : problem.conditions) {
        if (condition.on({point[0], point[1], point[2], point[3]}).lower() < 0.0) return std::nullopt;
    }
    if (ofRadius) {
        const double radius = std::sqrt(squaredRadius(cornersOf(problem.alternatives[0][0], point)));
        return Range{radius, radius};
    }
    SliceQuality taken = qualityOf(problem.alternatives[0], point);
    for (std::size_t i = 1; i < problem.alternatives.size(); ++i) {
        const SliceQuality other = qualityOf(problem.alternatives[i], point);
        const bool wins = problem.policy == Policy::Algorithm4
                              ? better(other, taken)
                              : version3Quality(other) > version3Quality(taken);
        if (wins) taken = other;
    }
    if (taken.inverted) return Range{0.0, 180.0};
    return Range{angleOf(taken.maxCos), angleOf(taken.minCos)};
}

namespace {

/// Keeps the extremes of the points it is shown.
class Extremist {
public:
    Extremist(const Problem& problem, bool ofRadius) : mProblem(problem), mOfRadius(ofRadius) {}

    void look(const Point& point) {
        const std::optional<Range> range = rangeAt(mProblem, point, mOfRadius);
        if (!range) return;
        if (range->min < mFound.min) {
            mFound.min = range->min;
            mFound.minAt = point;
        }
        if (range->max > mFound.max) {
            mFound.max = range->max;
            mFound.maxAt = point;
        }
    }

    /// Go on from the extremes along the axes and diagonals, by steps that are halved when none helps.
    void climb() {
        climb(mFound.min, mFound.minAt);
        climb(mFound.max, mFound.maxAt);
    }

    const Extremes& found() const { return mFound; }

private:
    void climb(const double& extreme, const Point& at) {
        if (mFound.max == 0.0) return;
        for (double step = 0.0625; step > 1e-8;) {
            const Point from = at;
            const double before = extreme;
            for (int n = 0; n < 81; ++n) {
                Point to = from;
                for (int p = 0, rest = n; p < kParameters; ++p, rest /= 3) {
                    const Interval& side = mProblem.domain[p];
                    to[p] =
                        std::clamp(from[p] + step * width(side) * (rest % 3 - 1), side.lower(), side.upper());
                }
                look(to);
            }
            if (std::abs(extreme - before) < 1e-6) step *= 0.5;
        }
    }

    const Problem& mProblem;
    bool mOfRadius;
    Extremes mFound;
};

} // namespace

Result prove(const Problem& problem, const Limits& limits) {
    Result result;
    const Judge judge(problem, limits);
    Extremist extremist(problem, limits.isRadius);
    const auto fails = [&](Judge::Part part, const Point& point) {
        part.box = {point[0], point[1], point[2], point[3]};
        if (judge(part) != Verdict::Violated) return false;
        result.failure = around(judge, problem.domain, point);
        result.extremes = extremist.found();
        return true;
    };
    for (int n = 0; n < 1 << kParameters; ++n) {
        const Point corner = cornerOf(problem.domain, n);
        extremist.look(corner);
        if (fails({}, corner)) return result;
    }
    std::vector<Judge::Part> waiting{{problem.domain, {}, {}}};
    while (!waiting.empty()) {
        Judge::Part part = waiting.back();
        waiting.pop_back();
        ++result.boxes;
        const Verdict verdict = judge(part);
        if (verdict == Verdict::Holds) continue;
        const Box box = part.box;
        const int side = widestSide(box);
        if (verdict == Verdict::Violated || width(box[side]) <= kSmallest) {
            result.failure = Failure{box, verdict == Verdict::Violated};
            result.extremes = extremist.found();
            return result;
        }
        const Point centre = centreOf(box);
        extremist.look(centre);
        if (fails(part, centre)) return result;
        const double middle = median(box[side]);
        part.box[side] = Interval(middle, box[side].upper());
        waiting.push_back(part);
        part.box[side] = Interval(box[side].lower(), middle);
        waiting.push_back(part);
    }
    extremist.climb();
    result.extremes = extremist.found();
    return result;
}

} // namespace vdbtet::proof
