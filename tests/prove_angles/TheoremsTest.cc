/// The bounds of docs/angles.md are proved, wrong ones are refuted, and all threads tell the same.
#include "support/Catch.h"

#include "flips/Slices.h"
#include "prove_angles/Theorems.h"

#include <tbb/global_control.h>

#include <cmath>

namespace vdbtet::test {

using namespace proof;

namespace {

constexpr double kDegree = 0.017453292519943295;

const Theorem& theorem(const std::string& id) {
    for (const Theorem& one : theorems()) {
        if (one.id == id) return one;
    }
    throw std::invalid_argument("no theorem " + id);
}

void requireProof(const std::string& id, const Bound& bound) {
    INFO(id);
    const Proof proof = proveTheorem(theorem(id), bound);
    INFO(proof.obstacle);
    REQUIRE(proof.proved);
    REQUIRE(proof.boxes >= std::int64_t(proof.kinds));
    REQUIRE(!proof.least.empty());
    if (bound.radius == 0.0) REQUIRE(proof.least[0].value > bound.min);
    REQUIRE(proof.greatest[0].value < (bound.radius == 0.0 ? bound.max : bound.radius));
}

} // namespace

TEST_CASE("the paper's bounds of single tets and of Algorithm 5 are proved", "[prove]") {
    for (const char* id : {"21", "22", "28", "28-best", "29", "6.2.2", "13"})
        requireProof(id, theorem(id).bound);
}

TEST_CASE("coarse bounds of version 3 on planes are proved", "[prove]") {
    requireProof("plane-0.7", {15.0, 150.0});
    requireProof("plane-0.7-active", theorem("plane-0.7-active").bound);
}

TEST_CASE("all bounds are proved", "[prove][slow]") {
    for (const Theorem& one : theorems()) requireProof(one.id, one.bound);
}

TEST_CASE("the extremes that are attained are those of the paper", "[prove]") {
    const Proof proof = proveTheorem(theorem("21"), theorem("21").bound);
    REQUIRE(proof.least.size() == 1);
    REQUIRE(proof.least[0].value == Approx(8.5480).margin(1e-4));
    REQUIRE(proof.greatest[0].value == Approx(164.1759).margin(1e-4));
    REQUIRE(proof.least[0].at == Point{0.5, 0.5, 0.5, 0.0});
}

TEST_CASE("wrong bounds are refuted by a box all of which violates them", "[prove]") {
    for (const Bound& wrong : {Bound{8.6, 164.18}, Bound{8.54, 164.1}}) {
        const Limits limits(wrong);
        int refuted = 0;
        for (const Problem& problem : theorem("21").problems()) {
            const Result result = prove(problem, limits);
            if (!result.failure) continue;
            ++refuted;
            REQUIRE(result.failure->violated);
            Judge::Part part{result.failure->box, {}, {}};
            REQUIRE(Judge(problem, limits)(part) == Verdict::Violated);
            Point centre;
            for (int p = 0; p < kParameters; ++p) centre[p] = median(result.failure->box[p]);
            const auto range = rangeAt(problem, centre, false);
            REQUIRE(range.has_value());
            REQUIRE((range->min <= wrong.min || range->max >= wrong.max));
        }
        REQUIRE(refuted == 1);
    }
    REQUIRE(!proveTheorem(theorem("13"), {0.0, 180.0, 1.07}).proved);
    REQUIRE(!proveTheorem(theorem("6.2.2"), {12.0, 147.5}).proved); // more than the policy looks for
}

TEST_CASE("slices of the greater worth carry the bounds of tets and active edges over to version 3",
          "[prove]") {
    const auto worthOf = [](const Bound& bound) {
        return worth({false, std::cos(bound.max * kDegree), std::cos(bound.min * kDegree)});
    };
    const auto boundOf = [](double worth) { return Bound{worth, 180.0 - worth / 0.54}; };
    const Bound always = theorem("21").bound;
    const Bound active = boundOf(worthOf(theorem("24").bound) - kTieAngle),
                flipped = boundOf(worthOf(always) + 0.1);
    for (const Bound& bound : {active, flipped}) {
        REQUIRE(worthOf(bound) == Approx(bound.min));
        REQUIRE(bound.min > always.min);
        REQUIRE(bound.max < always.max);
    }
}

TEST_CASE("a proof is the same on any number of threads", "[prove]") {
    const auto on = [](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return proveTheorem(theorem("29"), {13.39, 156.5});
    };
    const Proof one = on(1), four = on(4);
    REQUIRE(!one.proved);
    REQUIRE(one.obstacle == four.obstacle);
    REQUIRE(one.boxes == four.boxes);
}

} // namespace vdbtet::test
