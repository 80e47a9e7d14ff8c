/// @file CutDistances.cc
/// distanceToCut() in lanes: each goes through the steps of rootInUnitInterval() and stops by itself.
#include "field/CutDistances.h"

#include "field/Root.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbtet {

namespace {

constexpr int kLanes = 16;

/// As many edges as there are lanes.
struct Lanes {
    double b0[kLanes], b1[kLanes], b2[kLanes], b3[kLanes];
    double start, slope; ///< the diagonal's parameter is start + slope * (fraction of the edge's near half)

    VDBTET_KERNEL inline void load(const CutEdges& edges, std::size_t first, int count) {
        for (int i = 0; i < kLanes; ++i) {
            const std::size_t edge = first + std::size_t(std::min(i, count - 1));
            b0[i] = edges.b0[edge];
            b1[i] = edges.b1[edge];
            b2[i] = edges.b2[edge];
            b3[i] = edges.b3[edge];
        }
    }
    VDBTET_KERNEL inline double evaluate(int i, double x) const {
        return Diagonal{b0[i], b1[i], b2[i], b3[i]}(start + slope * x);
    }
};

/// @param f0  the field at the near end
VDBTET_KERNEL inline void nearHalfRoots(const Lanes& lanes, double (&f0)[kLanes], double (&root)[kLanes]) {
    double f1[kLanes], a[kLanes], b[kLanes], last[kLanes], stayed[kLanes], side[kLanes];
    std::int64_t active[kLanes]; // 0 or 1, as wide as a double
    for (int i = 0; i < kLanes; ++i) {
        f1[i] = lanes.evaluate(i, 1.0);
        side[i] = f0[i] >= 0.0 ? 1.0 : -1.0;
        // By the rule for ties the cut point may lie just beyond the middle.
        const double side1 = f1[i] >= 0.0 ? 1.0 : -1.0;
        const bool beyond = side[i] == side1;
        active[i] = beyond | (f0[i] == 0.0) | (f1[i] == 0.0) ? 0 : 1;
        root[i] = beyond | (f0[i] != 0.0) ? 1.0 : 0.0;
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
            const double x = (secant > a[i]) & (secant < b[i]) ? secant : middle;
            const double fx = lanes.evaluate(i, x);
            const bool found = (fx == 0.0) | (std::abs(x - last[i]) < kRootTolerance) |
                               (b[i] - a[i] < kRootTolerance);
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

void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa) {
    runOn(isa, [&]() VDBTET_KERNEL {
        Lanes lanes;
        lanes.start = nearIsB ? 1.0 : 0.0;
        lanes.slope = nearIsB ? -0.5 : 0.5;
        for (std::size_t first = 0; first < edges.size(); first += kLanes) {
            const int count = int(std::min<std::size_t>(kLanes, edges.size() - first));
            double near[kLanes], root[kLanes];
            lanes.load(edges, first, count);
            for (int i = 0; i < kLanes; ++i) near[i] = edges.near[first + std::size_t(std::min(i, count - 1))];
            nearHalfRoots(lanes, near, root);
            for (int i = 0; i < count; ++i) distance[first + std::size_t(i)] = float(0.5 * root[i]);
        }
    });
}

} // namespace vdbtet
