/// @file Tell.cc
/// Sums and bounds.
#include "Tell.h"

#include "Limits.h"
#include "guard/Guard.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

/// The largest distance between neighbouring numbers of @a digits mantissa bits up to @a magnitude, as a
/// fraction of @a spacing.
double roundingStep(double magnitude, int digits, double spacing) {
    return std::ldexp(1.0, std::ilogb(magnitude) + 1 - digits) / spacing;
}

AngleRange provenAngles(bool passed, const Report& report) {
    constexpr AngleRange kResolved{11.47, 157.59}; // theorem 2, and what repair lets pass
    if (report.tiger == 3 && passed)
        return report.boundary.filled > 0 ? kResolved : AngleRange{kGuardMin, kGuardMax};
    if (report.tiger == 2 && report.conflicts == 0) return kResolved;
    if (report.tiger == 2 && report.conflicts == report.lastResortFlips)
        return {11.46, kResolved.max}; // theorem 3
    return {8.54, 164.18};
}

} // namespace

void tellLabels(const Labels& labels, const Flips& flips, Report& report) {
    report.backLabelled = labels.backLabelled;
    report.tieBroken = labels.tieBroken;
    report.worklistSeconds = labels.worklistSeconds;
    report.activeFlips = flips.active;
    report.qualityFlips = flips.quality;
    report.extraFlips = flips.extra;
    report.lastResortFlips = flips.lastResort;
    report.conflicts = flips.conflicts;
}

void tellNumbers(const Numbering& numbering, const Options& options, bool passed, Report& report) {
    report.points = numbering.points();
    report.tets = numbering.tets();
    report.boundaryTriangles = numbering.triangles();
    report.tetsOfLevel = numbering.tetsOfLevel;
    while (report.tetsOfLevel.size() > 1 && report.tetsOfLevel.back() == 0) report.tetsOfLevel.pop_back();
    report.ambiguous = numbering.ambiguous;
    report.bounds = numbering.bounds;
    if (report.tets == 0) {
        throw NoSurface(
            "the shape is thinner than the lattice can hold, and nothing of it is left; use a finer spacing");
    }
    requireFewTets(report.tets, options);
    const AngleRange proven = provenAngles(passed, report);
    report.angleMin = proven.min;
    report.angleMax = proven.max;
}

void tellAngles(AngleSum& angles, const Optimized* optimized, Report& report) {
    report.angles = angles.stats();
    report.percentiles = angles.percentiles();
    report.angleBins = angles.bins();
    report.anglesBefore = {report.angles.min, report.angles.max};
    if (!optimized) return;
    // What was not measured before are tets of the lattice.
    report.anglesBefore = {std::min(optimized->before.min, 60.0), std::max(optimized->before.max, 90.0)};
    report.verticesMoved = optimized->verticesMoved;
    report.sweeps = optimized->sweeps;
}

MeshTotals totalsOf(const Numbering& numbering, const Frame& frame) {
    // A dihedral angle turns by at most about 35 times the relative error of its vertices: two faces, each
    // tilted by the errors of its three vertices over heights that the angle bounds keep above c / 6.
    constexpr double kRadiansPerError = 35.0;
    constexpr double kNegligible = 0.01 / 57.29577951308232; // 0.01 degrees
    MeshTotals totals;
    totals.points = numbering.points();
    totals.tets = numbering.tets();
    totals.triangles = numbering.triangles();
    totals.bounds = numbering.bounds;
    double magnitude = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        magnitude = std::max(
            {magnitude, std::abs(numbering.bounds.min()[axis]), std::abs(numbering.bounds.max()[axis])});
    }
    const auto turn = [&](int digits) {
        return kRadiansPerError * 0.5 * roundingStep(magnitude, digits, frame.spacing);
    };
    constexpr double kMaxFloat = 1e38, kMinFloat = 1e-30;
    totals.float32Suffices = turn(24) <= kNegligible && magnitude < kMaxFloat && frame.spacing > kMinFloat;
    if (!(turn(53) <= kNegligible)) {
        throw TooLarge(
            "the grid lies so far from the world's origin that double precision cannot resolve its lattice; "
            "move it nearer, or use a coarser spacing");
    }
    return totals;
}

} // namespace vdbtet
