/// @file VertexStep.cc
/// Descent on the worst qualities of a ball, after Freitag and Ollivier-Gooch ("Tetrahedral mesh improvement
/// using swapping and smoothing", 1997): along the shortest vector of the hull of their gradients.
#include "optimize/VertexStep.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbtet {

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace {

constexpr int kMostActive = 5;
/// A tet is active whose quality is below this much of the worst, and a little.
constexpr double kActiveShare = 1.3, kActiveMore = 0.01;
/// The worst quality must rise by more than this.
constexpr double kLeastGain = 1e-6;
/// Lattice units; and how often it is halved where it is too long.
constexpr double kStep = 0.15;
constexpr int kHalvings = 3;
constexpr int kNewtonSteps = 4;
/// Where a ball stays worse than the guard, it is moved on up to so often.
constexpr int kMoves = 3;
/// The normal must not turn away from the gradient farther than by this cosine.
constexpr double kLeastSlope = 0.2;

/// Squared sines of 25 and 140 degrees.
constexpr double kAcuteGuard = 0.17860619515673035, kObtuseGuard = 0.41317591116653485;

/// @return the shortest vector in the hull of some, nearly (Frank and Wolfe's method).
Vec3d shortestInHull(const Vec3d* corners, int count) {
    constexpr int kSteps = 12;
    Vec3d shortest = corners[0];
    for (int step = 0; step < kSteps; ++step) {
        const Vec3d* next = std::min_element(corners, corners + count, [&](const Vec3d& a, const Vec3d& b) {
            return a.dot(shortest) < b.dot(shortest);
        });
        const Vec3d way = *next - shortest;
        const double gain = -way.dot(shortest), square = way.lengthSqr();
        if (!(gain > 1e-12 * shortest.lengthSqr()) || square == 0.0) break;
        shortest += std::min(1.0, gain / square) * way;
    }
    return shortest;
}

} // namespace

class VertexStep::Directions {
public:
    /// @param gradients  of the active tets' qualities, worst first
    Directions(const std::array<Vec3d, kMostActive>& gradients, int count) {
        for (int corners = count; corners >= 2; --corners) add(shortestInHull(gradients.data(), corners));
        add(gradients[0]);
    }
    const Vec3d* begin() const { return mUnits.data(); }
    const Vec3d* end() const { return mUnits.data() + mCount; }

private:
    void add(const Vec3d& direction) {
        const double length = direction.length();
        if (length > 1e-6) mUnits[std::size_t(mCount++)] = direction / length;
    }
    std::array<Vec3d, kMostActive> mUnits;
    int mCount = 0;
};

bool VertexStep::project(const Vec3d& origin, const Vec3d& normal, Vec3d& place) {
    for (int step = 0;; ++step) {
        const FieldPoint point = mProbe->at(origin + place);
        if (!point.steep) return false;
        const double steepness = point.gradient.length();
        if (std::abs(point.phi) <= mGoals.tolerance * steepness) return true;
        const double slope = point.gradient.dot(normal);
        if (step == kNewtonSteps || !(std::abs(slope) > kLeastSlope * steepness)) return false;
        const double way = -point.phi / slope;
        if (std::abs(way) > kStep) return false;
        place += way * normal;
    }
}

VertexStep::Outcome VertexStep::improve(Ball& ball, bool slides, const Vec3d& origin, const Vec3d& home,
                                        Vec3f& offset) {
    BallQuality quality = ball.judge(home + Vec3d(offset));
    if (quality.quality() >= mGoals.quality) return Outcome::Fine;
    for (int moves = 0; moves < kMoves; ++moves) {
        if (!move(ball, quality, slides, origin, home, offset))
            return moves == 0 ? Outcome::Stuck : Outcome::Moved;
        quality = ball.judge(home + Vec3d(offset));
        if (quality.quality() >= std::min(mGoals.quality, kAcuteGuard)) break;
    }
    return Outcome::Moved;
}

bool VertexStep::move(Ball& ball, const BallQuality& before, bool slides, const Vec3d& origin,
                      const Vec3d& home, Vec3f& offset) {
    const Vec3d start = home + Vec3d(offset);
    const double worst = before.quality();
    ball.sort(kMostActive);
    int active = 1;
    while (active < std::min(kMostActive, ball.size()) &&
           ball.quality(active) < kActiveShare * worst + kActiveMore)
        ++active;

    std::array<Vec3d, kMostActive> gradients;
    ball.gradients(start, active, gradients.data());
    Vec3d normal(0.0);
    if (slides) {
        const FieldPoint point = mProbe->at(origin + start);
        if (!point.steep) return false;
        normal = point.gradient.unit();
        for (int i = 0; i < active; ++i) gradients[i] -= gradients[i].dot(normal) * normal;
    }

    const BallLimits limits{worst + kLeastGain, std::min(before.acute, kAcuteGuard),
                            std::min(before.obtuse, kObtuseGuard)};
    for (const Vec3d& direction : Directions(gradients, active)) {
        double length = kStep;
        for (int halving = 0; halving <= kHalvings; ++halving, length *= 0.5) {
            Vec3d place = start + length * direction;
            if (slides && !project(origin, normal, place)) continue;
            const Vec3f rounded(place - home);
            if (!ball.passes(home + Vec3d(rounded), limits)) continue;
            offset = rounded;
            return true;
        }
    }
    return false;
}

} // namespace vdbtet
