// The quality of tets and of balls.
#include "support/Catch.h"
#include "support/Fixtures.h"

#include "optimize/Ball.h"
#include "optimize/PoorTets.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>
#include <vector>

using openvdb::Vec3d;

namespace vdbtet::test {

namespace {

std::vector<Isa> isas() {
    std::vector<Isa> all;
    for (const Isa isa : {Isa::Plain, Isa::Avx2, Isa::Avx512}) {
        if (supports(isa)) all.push_back(isa);
    }
    return all;
}

Triple triple(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

double qualityOf(const std::array<Vec3d, 4>& p) {
    return tetQuality(tetAngles(triple(p[0]), triple(p[1]), triple(p[2]), triple(p[3])));
}

std::array<Vec3d, 4> randomTet(Random& random) {
    std::array<Vec3d, 4> p;
    for (Vec3d& v : p) v = random.inBox(-1, 1);
    return p;
}

/// A vertex in the middle of an octahedron.
struct Star {
    std::vector<std::array<Vec3d, 3>> faces;

    explicit Star(Random& random) {
        Vec3d corners[6];
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                Vec3d corner = random.inBox(-0.2, 0.2);
                corner[axis] += 2 * side - 1;
                corners[2 * axis + side] = corner;
            }
        }
        for (int octant = 0; octant < 8; ++octant) {
            const int x = octant >> 2, y = octant >> 1 & 1, z = octant & 1;
            std::array<Vec3d, 3> face{corners[x], corners[2 + y], corners[4 + z]};
            if (face[0].cross(face[1]).dot(face[2]) < 0) std::swap(face[0], face[1]);
            faces.push_back(face);
        }
    }

    Ball ball(Isa isa) const {
        Ball result(isa);
        int i = 0;
        for (const auto& f : faces) {
            result.add({i, i, i}, f[0], f[1], f[2]);
            ++i;
        }
        result.complete();
        return result;
    }
};

} // namespace

TEST_CASE("the quality of a tet is the squared sine of its sharpest angle, obtuse ones weighted",
          "[optimize]") {
    Random random(1);
    int inverted = 0;
    for (int i = 0; i < 1000; ++i) {
        auto p = randomTet(random);
        if (signedVolume6(p[0], p[1], p[2], p[3]) <= kLeastVolume6) {
            REQUIRE(qualityOf(p) == -1.0);
            std::swap(p[0], p[1]);
            ++inverted;
        }
        double expected = kObtuseWeight;
        for (const double angle : dihedralAngles(p[0], p[1], p[2], p[3])) {
            const double sine = std::sin(angle / 57.29577951308232);
            expected = std::min(expected, sine * sine * (angle > 90 ? kObtuseWeight : 1.0));
        }
        REQUIRE(qualityOf(p) == Approx(expected).margin(1e-9));
    }
    REQUIRE(inverted > 300);
    // A target of 30 degrees asks for no more than 131.
    REQUIRE(std::asin(0.5 / 0.66) * 57.29577951308232 == Approx(180 - 130.75).margin(0.01));
}

TEST_CASE("a tet of the lattice is as good as can be", "[optimize]") {
    REQUIRE(qualityOf({Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0.5, 0.5, 0.5), Vec3d(0.5, -0.5, 0.5)}) ==
            Approx(kObtuseWeight));
    REQUIRE(qualityOf({Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0.5, -0.5, 0.5), Vec3d(0.5, 0.5, 0.5)}) == -1.0);
}

TEST_CASE("a ball is as good as its worst tet, on every instruction set", "[optimize][simd]") {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        const Star star(random);
        const Vec3d at = random.inBox(-0.3, 0.3);
        std::vector<double> expected;
        for (const auto& f : star.faces) expected.push_back(qualityOf({at, f[0], f[1], f[2]}));
        const double worst = *std::min_element(expected.begin(), expected.end());
        for (const Isa isa : isas()) {
            Ball ball = star.ball(isa);
            const BallQuality quality = ball.judge(at);
            REQUIRE(quality.quality() == worst);
            for (int t = 0; t < ball.size(); ++t) REQUIRE(ball.quality(t) == expected[std::size_t(t)]);
            REQUIRE(ball.passes(at, {worst - 1e-12, quality.acute, quality.obtuse}) == !quality.inverted);
            REQUIRE_FALSE(ball.passes(at, {worst, quality.acute, quality.obtuse}));
            REQUIRE_FALSE(ball.passes(at, {worst - 1e-12, quality.acute + 1e-12, quality.obtuse}));
            REQUIRE_FALSE(ball.passes(at, {worst - 1e-12, quality.acute, quality.obtuse + 1e-12}));
            ball.sort(3);
            auto sorted = expected;
            std::sort(sorted.begin(), sorted.end());
            for (int t = 0; t < 3; ++t) {
                REQUIRE(ball.quality(t) == sorted[std::size_t(t)]);
                REQUIRE(ball.quality(t) == expected[std::size_t(ball.face(t)[0])]);
            }
        }
    }
}

TEST_CASE("gradients tell how qualities change", "[optimize]") {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Star star(random);
        const Vec3d at = random.inBox(-0.1, 0.1), step = 1e-4 * random.inBox(-1, 1);
        Ball ball = star.ball(bestIsa());
        ball.judge(at);
        Vec3d gradients[Ball::kLanes];
        double before[Ball::kLanes];
        ball.gradients(at, Ball::kLanes, gradients);
        for (int t = 0; t < Ball::kLanes; ++t) before[t] = ball.quality(t);
        ball.judge(at + step);
        int smooth = 0; // elsewhere another angle has become the sharpest
        for (int t = 0; t < Ball::kLanes; ++t)
            smooth += std::abs(ball.quality(t) - before[t] - gradients[t].dot(step)) < 1e-6;
        CHECK(smooth >= Ball::kLanes - 2);
    }
}

TEST_CASE("poor tets are found in batches, the same on every instruction set", "[optimize][simd]") {
    constexpr double kTarget = 0.1;
    for (const Isa isa : isas()) {
        Random random(4);
        PoorTets poor(kTarget, isa);
        std::vector<int> expected, found;
        double widest = 0, sharpest = 180;
        const auto onPoor = [&](const std::array<int, 4>& ids) { found.push_back(ids[0]); };
        for (int i = 0; i < 200; ++i) {
            const auto p = randomTet(random);
            if (qualityOf(p) < kTarget) expected.push_back(i);
            for (const double angle : dihedralAngles(p[0], p[1], p[2], p[3])) {
                widest = std::max(widest, angle);
                sharpest = std::min(sharpest, angle);
            }
            poor.add({i, i, i, i}, p, onPoor);
        }
        poor.flush(onPoor);
        REQUIRE(found == expected);
        REQUIRE(angleOfSquare(poor.most()) == Approx(sharpest));
        REQUIRE(angleOfSquare(poor.least()) == Approx(widest));
    }
}

} // namespace vdbtet::test
