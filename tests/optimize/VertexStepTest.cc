// What one step of one vertex promises.
#include "support/Catch.h"
#include "support/Fixtures.h"

#include "optimize/VertexStep.h"

#include <algorithm>
#include <cmath>
#include <functional>

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace vdbtet::test {

namespace {

constexpr double kTolerance = 1e-4;
const double kTarget = 0.25; // sin^2 of 30 degrees

struct FunctionProbe final : Field::Probe {
    explicit FunctionProbe(std::function<FieldPoint(const Vec3d&)> field) : function(std::move(field)) {}
    FieldPoint at(const Vec3d& place) override { return function(place); }
    std::function<FieldPoint(const Vec3d&)> function;
};

FieldPoint ballOfTen(const Vec3d& p) { return {10.0 - p.length(), -p.unit(), true}; }

VertexStep stepIn(std::function<FieldPoint(const Vec3d&)> field) {
    return VertexStep(std::make_unique<FunctionProbe>(std::move(field)), {kTarget, kTolerance});
}

/// The tets between @a at and the outside of a random octahedron around @a centre; of its half below where
/// @a half is set.
Ball ballAround(const Vec3d& centre, bool half, Random& random) {
    Vec3d corners[6];
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
            Vec3d corner = random.inBox(-0.25, 0.25);
            corner[axis] += 2 * side - 1;
            corners[2 * axis + side] = 0.7 * corner + centre;
        }
    }
    Ball ball;
    for (int octant = 0; octant < 8; ++octant) {
        const int x = octant >> 2, y = octant >> 1 & 1, z = octant & 1;
        if (half && x == 1) continue;
        Vec3d a = corners[x], b = corners[2 + y], c = corners[4 + z];
        if ((a - centre).cross(b - centre).dot(c - centre) < 0) std::swap(a, b);
        ball.add({}, a, b, c);
    }
    ball.complete();
    return ball;
}

void requireBetter(const BallQuality& before, const BallQuality& after) {
    const auto sine2 = [](double angle) { return std::pow(std::sin(angle / 57.29577951308232), 2); };
    REQUIRE_FALSE(after.inverted);
    REQUIRE(after.quality() > before.quality());
    REQUIRE(after.acute >= std::min(before.acute, sine2(25) - 1e-12));
    REQUIRE(after.obtuse >= std::min(before.obtuse, sine2(140) - 1e-12));
}

} // namespace

TEST_CASE("a step inside makes the ball better and keeps the guard", "[optimize]") {
    Random random(1);
    VertexStep step = stepIn([](const Vec3d&) -> FieldPoint { throw std::logic_error("not asked for"); });
    int moved = 0, fine = 0, stuck = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d home = random.inBox(0, 8);
        Ball ball = ballAround(home, false, random);
        const Vec3f start(random.inBox(-0.25, 0.25));
        Vec3f offset = start;
        const BallQuality before = ball.judge(home + Vec3d(start));
        const auto outcome = step.improve(ball, false, Vec3d(0.0), home, offset);
        const BallQuality after = ball.judge(home + Vec3d(offset));
        if (outcome == VertexStep::Outcome::Moved) {
            ++moved;
            requireBetter(before, after);
        } else {
            REQUIRE(offset == start);
            const bool isFine = before.quality() >= kTarget;
            REQUIRE((outcome == VertexStep::Outcome::Fine) == isFine);
            ++(isFine ? fine : stuck);
        }
    }
    CHECK(moved > 500);
    CHECK(fine > 50);
    CHECK(stuck < moved / 10);
}

TEST_CASE("a step along the surface stays on it", "[optimize]") {
    Random random(2);
    VertexStep step = stepIn(ballOfTen);
    int moved = 0;
    for (int i = 0; i < 2000; ++i) {
        // The vertex near (10,0,0), the tile's origin anywhere.
        const Vec3d origin = 8.0 * Vec3d(i % 3, i % 5, i % 7);
        const Vec3d place = 10.0 * Vec3d(10.0, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)).unit();
        const Vec3d home = Vec3d(10, 0, 0) - origin + random.inBox(-0.1, 0.1);
        Ball ball = ballAround(Vec3d(10, 0, 0) - origin, true, random);
        const Vec3f start(place - origin - home);
        Vec3f offset = start;
        const BallQuality before = ball.judge(home + Vec3d(start));
        if (step.improve(ball, true, origin, home, offset) != VertexStep::Outcome::Moved) continue;
        ++moved;
        requireBetter(before, ball.judge(home + Vec3d(offset)));
        REQUIRE(std::abs((origin + home + Vec3d(offset)).length() - 10.0) < kTolerance + 1e-6);
    }
    CHECK(moved > 500);
}

TEST_CASE("no scale of the field matters, but one that has no slope stops a point", "[optimize]") {
    const Vec3d home(10, 0, 0);
    const auto moveIn = [&](std::function<FieldPoint(const Vec3d&)> field) {
        Random random(5);
        Ball ball = ballAround(home, true, random);
        Vec3f offset(Vec3d(10.0 * Vec3d(10, 0.3, -0.2).unit() - home));
        VertexStep step = stepIn(std::move(field));
        const auto outcome = step.improve(ball, true, Vec3d(0.0), home, offset);
        return std::make_pair(outcome, offset);
    };
    const auto moved = moveIn(ballOfTen);
    REQUIRE(moved.first == VertexStep::Outcome::Moved);
    for (const double scale : {std::ldexp(1.0, 100), std::ldexp(1.0, -100), -1.0}) {
        REQUIRE(moved == moveIn([=](const Vec3d& p) {
                    FieldPoint point = ballOfTen(p);
                    point.phi *= scale;
                    point.gradient *= scale;
                    return point;
                }));
    }
    const auto flat = moveIn([](const Vec3d&) { return FieldPoint{0.0, Vec3d(1, 0, 0), false}; });
    REQUIRE(flat.first == VertexStep::Outcome::Stuck);
}

} // namespace vdbtet::test
