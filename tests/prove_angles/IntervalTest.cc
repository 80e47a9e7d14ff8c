/// Intervals hold what real arithmetic gives, and slopes what the mean value theorem says.
#include "support/Catch.h"
#include "support/Fixtures.h"

#include "prove_angles/Shapes.h"

#include <cmath>

namespace vdbtet::test {

using namespace proof;

namespace {

/// A number of any magnitude that the proofs come by.
double anyNumber(Random& random) {
    return std::ldexp(random.uniform(-1.0, 1.0), int(random.uniform(-60.0, 60.0)));
}

} // namespace

TEST_CASE("sums, products, quotients and roots of intervals are rounded outward", "[prove]") {
    Random random(1);
    for (int i = 0; i < 200000; ++i) {
        const double x = anyNumber(random), y = anyNumber(random);
        // The error of a rounded sum or product is a double itself.
        const double sum = x + y, part = sum - x, sumError = (x - (sum - part)) + (y - part);
        const Interval sums = Interval(x) + Interval(y), differences = Interval(x) - Interval(-y);
        REQUIRE(sums.lower() - sum < sumError);
        REQUIRE(sums.upper() - sum > sumError);
        REQUIRE(differences.lower() == sums.lower());
        REQUIRE(differences.upper() == sums.upper());

        const double product = x * y, productError = std::fma(x, y, -product);
        const Interval products = Interval(x) * Interval(y);
        REQUIRE(products.lower() - product < productError);
        REQUIRE(products.upper() - product > productError);

        const Interval quotients = Interval(x) / Interval(y);
        REQUIRE(std::fma(quotients.lower(), std::abs(y), y > 0.0 ? -x : x) < 0.0);
        REQUIRE(std::fma(quotients.upper(), std::abs(y), y > 0.0 ? -x : x) > 0.0);

        const Interval roots = sqrt(Interval(std::abs(x)));
        REQUIRE(std::fma(roots.lower(), roots.lower(), -std::abs(x)) < 0.0);
        REQUIRE(std::fma(roots.upper(), roots.upper(), -std::abs(x)) > 0.0);
    }
}

TEST_CASE("a rounded bound lies at least one double outside, zeros and the smallest numbers too", "[prove]") {
    for (double x : {0.0, 1.0, -1.0, 0x1.fffffffffffffp0, -0x1.fffffffffffffp0, 0x1p-1022, 0x1p-1074,
                     -0x1p-1030, 1e300}) {
        REQUIRE(Outward::above(x) >= std::nextafter(x, INFINITY));
        REQUIRE(Outward::below(x) <= std::nextafter(x, -INFINITY));
    }
}

TEST_CASE("cosines of bounds hold the known ones and are narrow", "[prove]") {
    const double known[][2] = {{0.0, 1.0}, {60.0, 0.5}, {90.0, 0.0}, {120.0, -0.5}, {180.0, -1.0}};
    for (const auto& [degrees, cosine] : known) {
        const Interval range = cosineOfDegrees(degrees);
        REQUIRE(range.lower() < cosine);
        REQUIRE(range.upper() > cosine);
        REQUIRE(range.upper() - range.lower() < 1e-12);
    }
    for (double degrees = 1.0; degrees < 180.0; degrees += 0.7) {
        const Interval range = cosineOfDegrees(enclose(degrees));
        REQUIRE(median(range) == Approx(std::cos(degrees * std::acos(-1.0) / 180.0)).margin(1e-12));
    }
}

TEST_CASE("slopes on a box hold the differences of cosines in it", "[prove]") {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        Tet tet;
        for (int c = 0; c < 4; ++c) {
            const auto& step = bcc::kOctahedra[0][0][bcc::kSliceTets[bcc::S][i % 4][c]];
            tet[c].home = {step.x + 0.5 * step.lattice, step.y + 0.5 * step.lattice,
                           step.z + 0.5 * step.lattice};
            tet[c].kind = i % 3 == 0 ? Corner::Plane : c == 0 ? Corner::Still : Corner::Along;
            tet[c].parameter = i % 3 == 0 ? c % 2 : c - 1;
            for (double& component : tet[c].edge) component = random.uniform(-0.5, 0.5);
        }
        Box box;
        Point from, to;
        for (int p = 0; p < kParameters; ++p) {
            const double low = random.uniform(0.0, 0.4), high = low + random.uniform(0.01, 0.05);
            box[p] = Interval(low, high);
            from[p] = to[p] = random.uniform(low, high);
        }
        const int varied = i % kParameters;
        from[varied] = box[varied].lower();
        to[varied] = box[varied].upper();
        const auto cosineAt = [&](const auto& at) {
            const auto corners = cornersOf(tet, at);
            return cosineBetween(normal(corners, kEdgeFaces[i % 6][0]),
                                 normal(corners, kEdgeFaces[i % 6][1]));
        };
        const double before = cosineAt(from), after = cosineAt(to),
                     slope = (after - before) / (to[varied] - from[varied]);
        const Jet jet = cosineAt(jetsOf(box));
        REQUIRE(jet.value.lower() <= before);
        REQUIRE(jet.value.upper() >= before);
        REQUIRE(jet.slope[varied].lower() <= slope + 1e-9);
        REQUIRE(jet.slope[varied].upper() >= slope - 1e-9);
    }
}

} // namespace vdbtet::test
