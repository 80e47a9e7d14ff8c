/// @file CutDistances.cc
/// distanceToCut() in lanes: each goes through the steps of rootInUnitInterval() and stops by itself.
#include "field/CutDistances.h"

#include "field/Root.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbtet {

namespace {

constexpr int kLanes = CutEdges::kLanes;

/// The diagonals of all lanes.
struct Lanes {
    double b0[kLanes], b1[kLanes], b2[kLanes], b3[kLanes];
    double start = 0.0,
           slope = 0.0; ///< the diagonal's parameter is start + slope * (fraction of the near half)

    VDBTET_KERNEL inline explicit Lanes(const CutEdges& edges) {
        for (int i = 0; i < kLanes; ++i) {
            const auto& p = edges.corners;
            const double corners[8] = {p[0][i], p[1][i], p[2][i], p[3][i],
                                       p[4][i], p[5][i], p[6][i], p[7][i]};
            const Diagonal phi = Diagonal::of(corners);
            b0[i] = phi.b0;
            b1[i] = phi.b1;
            b2[i] = phi.b2;
            b3[i] = phi.b3;
        }
    }
    VDBTET_KERNEL inline Diagonal diagonal(int i) const { return {b0[i], b1[i], b2[i], b3[i]}; }
    VDBTET_KERNEL inline double evaluate(int i, double x) const { return diagonal(i)(start + slope * x); }
};

/// @param near  the field at the near end
/// @param count  lanes beyond it are left alone
VDBTET_KERNEL inline void nearHalfRoots(const Lanes& lanes, const double (&near)[kLanes], int count,
                                        double (&root)[kLanes]) {
    double f0[kLanes], f1[kLanes], a[kLanes], b[kLanes], last[kLanes], stayed[kLanes], side[kLanes];
    std::int64_t active[kLanes]; // 0 or 1, as wide as a double
    for (int i = 0; i < kLanes; ++i) {
        f0[i] = near[i];
        f1[i] = lanes.evaluate(i, 1.0);
        side[i] = f0[i] >= 0.0 ? 1.0 : -1.0;
        // By the rule for ties the cut point may lie just beyond the middle.
        const double side1 = f1[i] >= 0.0 ? 1.0 : -1.0;
        const bool beyond = side[i] == side1;
        active[i] = (beyond | (f0[i] == 0.0) | (f1[i] == 0.0) | (i >= count)) ? 0 : 1;
        root[i] = (beyond | (f0[i] != 0.0)) ? 1.0 : 0.0;
        a[i] = 0.0;
        b[i] = 1.0;
        last[i] = 2.0;
        stayed[i] = 0.0;
    }
    for (int iteration = 0; iteration < kRootIterations; ++iteration) {
        std::int64_t left = 0;
        for (int i = 0; i < kLanes; ++i) left += active[i];
        if (left == 0) return;
        for (int i = 0; i < kLanes; ++i) {
            const double secant = (a[i] * f1[i] - b[i] * f0[i]) / (f1[i] - f0[i]);
            const double middle = 0.5 * (a[i] + b[i]);
            const double x = ((secant > a[i]) & (secant < b[i])) ? secant : middle;
            const double fx = lanes.evaluate(i, x);
            const bool found =
                (fx == 0.0) | (std::abs(x - last[i]) < kRootTolerance) | (b[i] - a[i] < kRootTolerance);
            root[i] = active[i] != 0 ? x : root[i];
            active[i] = found ? 0 : active[i];
            last[i] = x;
            const bool moveA = (fx >= 0.0 ? 1.0 : -1.0) == side[i];
            const double half0 = stayed[i] == 1.0 ? 0.5 * f0[i] : f0[i];
            const double half1 = stayed[i] == -1.0 ? 0.5 * f1[i] : f1[i];
            f0[i] = moveA ? fx : half0;
            f1[i] = moveA ? half1 : fx;
            a[i] = moveA ? x : a[i];
            b[i] = moveA ? b[i] : x;
            stayed[i] = moveA ? -1.0 : 1.0;
        }
    }
    for (int i = 0; i < kLanes; ++i) root[i] = active[i] != 0 ? 0.5 * (a[i] + b[i]) : root[i];
}

} // namespace

std::uint32_t cutsInFirstHalf(const CutEdges& edges, Isa isa) {
    std::uint32_t result = 0;
    runOn(isa, [&]() VDBTET_KERNEL {
        const Lanes lanes(edges);
        std::int64_t first[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            const Diagonal phi = lanes.diagonal(i);
            const double near = phi.b0, middle = phi(0.5), far = phi(1.0);
            const std::int64_t tie = std::abs(middle) <= kMiddle * std::abs(far - near) ? 1 : 0,
                               nearInside = near >= 0.0 ? 1 : 0, middleInside = middle >= 0.0 ? 1 : 0;
            first[i] = tie | (nearInside ^ middleInside);
        }
        for (int i = 0; i < kLanes; ++i) result |= std::uint32_t(first[i]) << i;
    });
    return edges.full() ? result : result & ((std::uint32_t(1) << edges.count) - 1);
}

void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa) {
    runOn(isa, [&]() VDBTET_KERNEL {
        Lanes lanes(edges);
        lanes.start = nearIsB ? 1.0 : 0.0;
        lanes.slope = nearIsB ? -0.5 : 0.5;
        double root[kLanes];
        nearHalfRoots(lanes, edges.near, edges.count, root);
        for (int i = 0; i < edges.count; ++i) distance[i] = float(0.5 * root[i]);
    });
}

} // namespace vdbtet
