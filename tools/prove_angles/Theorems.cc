/// @file Theorems.cc
/// The table of bounds, and proofs in parallel.
#include "Theorems.h"

#include "PlaneProblems.h"
#include "TigerProblems.h"

#include "flips/Slices.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbtet::proof {

namespace {

struct PlaneBounds {
    double tau;
    Bound tets, octahedra;
};
constexpr PlaneBounds kPlaneBounds[] = {
    {0.5, {17.4, 153.5}, {20.0, 145.0}},  {0.6, {18.6, 149.1}, {24.0, 138.0}},
    {0.7, {19.2, 145.1}, {28.0, 132.3}},  {0.75, {19.3, 143.2}, {30.0, 129.9}},
    {0.77, {19.4, 142.5}, {30.0, 129.9}},
};

std::vector<Theorem> makeTheorems() {
    std::vector<Theorem> all = {
        {"21", "a tet with one to three manifold vertices", {8.54, 164.18}, [] { return tetProblems(true); }},
        {"22", "the same, less Algorithm 5's worst tet", {13.26, 157.59}, [] { return tetProblems(false); }},
        {"24", "an active edge, Algorithm 4's slice", {11.47, 157.49}, activeProblems},
        {"28",
         "Algorithm 5, flipped to either slice",
         {18.53, 150.01},
         [] { return flippedProblems(false); }},
        {"28-best",
         "Algorithm 5, flipped to the mesher's slice",
         {25.35, 143.93},
         [] { return flippedProblems(true); }},
        {"29", "Algorithm 5's tet, one move at most 0.3", {13.39, 156.68}, shortMoveProblems},
        {"6.2.2", "last resort, the slice of the mesher", {11.46, 147.5}, lastResortProblems},
        {"13", "conflict: sphere through v2 to v4 and v5 or v6", {0.0, 180.0, 1.1}, sphereProblems},
    };
    for (const PlaneBounds& row : kPlaneBounds) {
        const double tau = row.tau;
        all.push_back({fmt::format("plane-{}", tau), fmt::format("version 3, tau = {}: a tet", tau), row.tets,
                       [tau] { return planeTetProblems(tau); }});
        all.push_back({fmt::format("plane-{}-active", tau),
                       fmt::format("version 3, tau = {}: an active edge", tau), row.octahedra,
                       [tau] { return planeOctahedronProblems(tau); }});
    }
    return all;
}

/// The bound that one of the alternatives must keep for the chosen one to keep @a bound.
Bound boundOfOne(const Problem& problem, Bound bound) {
    if (problem.policy != Policy::Algorithm4) return bound;
    const double ties = double(problem.alternatives.size() - 1) * kTieAngle;
    return {kMinAngle + ties, bound.max - ties, bound.radius};
}

/// Keep those of the largest values, less 1e-4.
void keepLargest(std::vector<Attained>& all, double sign) {
    double largest = -1e9;
    for (const Attained& one : all) largest = std::max(largest, sign * one.value);
    const auto less = [&](const Attained& one) { return sign * one.value < largest - 1e-4; };
    all.erase(std::remove_if(all.begin(), all.end(), less), all.end());
}

std::string describe(const Problem& problem, const Failure& failure) {
    std::string text =
        failure.violated ? "counter-example, all of this box:" : "undecided, this box is too small to halve:";
    for (int p = 0; p < kParameters; ++p) {
        if (singleton(problem.domain[p])) continue;
        text += fmt::format(" [{:.9g}, {:.9g}]", failure.box[p].lower(), failure.box[p].upper());
    }
    return text + " of " + problem.name;
}

} // namespace

const std::vector<Theorem>& theorems() {
    static const std::vector<Theorem> kTheorems = makeTheorems();
    return kTheorems;
}

Proof proveTheorem(const Theorem& theorem, const Bound& bound) {
    const std::vector<Problem> problems = theorem.problems();
    std::vector<Result> results(problems.size());
    tbb::parallel_for(std::size_t(0), problems.size(), [&](std::size_t i) {
        results[i] = prove(problems[i], Limits(boundOfOne(problems[i], bound)));
    });

    Proof proof;
    proof.kinds = problems.size();
    for (std::size_t i = 0; i < problems.size(); ++i) {
        const Problem& problem = problems[i];
        const Result& result = results[i];
        proof.configurations += problem.count;
        proof.boxes += result.boxes;
        if (result.failure && proof.obstacle.empty()) proof.obstacle = describe(problem, *result.failure);
        if (problem.policy == Policy::Algorithm4 && proof.obstacle.empty() &&
            bound.min > kMinAngle - double(problem.alternatives.size() - 2) * kTieAngle) {
            proof.obstacle = fmt::format("Algorithm 4 does not look for more than {} degrees", kMinAngle);
        }
        const Extremes& extremes = result.extremes;
        if (extremes.max == 0.0) continue; // no point meets the conditions
        proof.least.push_back({extremes.min, problem.name, extremes.minAt});
        proof.greatest.push_back({extremes.max, problem.name, extremes.maxAt});
    }
    proof.proved = proof.obstacle.empty();
    keepLargest(proof.least, -1.0);
    keepLargest(proof.greatest, 1.0);
    return proof;
}

} // namespace vdbtet::proof
