/// @file CutDistances.cc
/// Newton's method in lanes where an edge's cubic falls all the way; elsewhere one edge at a time.
#include "field/CutDistances.h"

#include "field/Root.h"

#include <cmath>
#include <cstdint>

namespace vdbtet {

namespace {

constexpr int kLanes = CutEdges::kLanes;

/// More steps than a cubic needs that is nearly straight.
constexpr int kNewtonSteps = 8;

/// The field on the part of each edge that its near end is the end of, as c0 + c1 x + c2 x^2 + c3 x^3 over
/// [0, 1], positive at the near end.
struct Cubics {
    double c0[kLanes], c1[kLanes], c2[kLanes], c3[kLanes];

    VDBTET_KERNEL inline void set(const CutEdges& edges, bool nearIsB, const double (&reach)[kLanes]) {
        for (int i = 0; i < kLanes; ++i) {
            const double b0 = edges.b0[i], b1 = edges.b1[i], b2 = edges.b2[i], b3 = edges.b3[i];
            // In powers of the fraction of the diagonal; then of that from its middle on, backwards.
            const double p1 = b1 - 3.0 * b0, p2 = 3.0 * b0 - 2.0 * b1 + b2, p3 = (b1 - b2) + (b3 - b0);
            const double q1 = -(p1 + p2 + 0.75 * p3), q2 = p2 + 1.5 * p3, q3 = -p3;
            const double side = edges.near[i] >= 0.0 ? 1.0 : -1.0, half = 0.5 * reach[i];
            c0[i] = side * edges.near[i];
            c1[i] = side * half * (nearIsB ? q1 : p1);
            c2[i] = side * half * half * (nearIsB ? q2 : p2);
            c3[i] = side * half * half * half * (nearIsB ? q3 : p3);
        }
    }

    VDBTET_KERNEL inline double operator()(int i, double x) const {
        return ((c3[i] * x + c2[i]) * x + c1[i]) * x + c0[i];
    }
    VDBTET_KERNEL inline double slope(int i, double x) const {
        return (3.0 * c3[i] * x + 2.0 * c2[i]) * x + c1[i];
    }
    /// Whether the Bernstein coefficients of the slope are negative, so that it is everywhere.
    VDBTET_KERNEL inline bool falls(int i) const {
        return (c1[i] < 0.0) & (c1[i] + c2[i] < 0.0) & (c1[i] + 2.0 * c2[i] + 3.0 * c3[i] < 0.0);
    }
};

} // namespace

void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa) {
    Cubics phi;
    double reach[kLanes], far[kLanes], root[kLanes];
    std::int64_t open[kLanes], falling[kLanes]; // 0 or 1, as wide as a double
    runOn(isa, [&]() VDBTET_KERNEL {
        for (int i = 0; i < kLanes; ++i) reach[i] = edges.near[i] >= 0.0 ? edges.tau[i] : 1.0 - edges.tau[i];
        phi.set(edges, nearIsB, reach);
        for (int i = 0; i < kLanes; ++i) {
            const double near = phi.c0[i];
            far[i] = phi(i, 1.0);
            // By the rule for ties the cut point may lie just beyond.
            const bool cut = (near > 0.0) & (far[i] < 0.0) & (i < edges.count);
            open[i] = cut ? 1 : 0;
            falling[i] = phi.falls(i) ? 1 : 0;
            root[i] = cut ? near / (near - far[i]) : near > 0.0 ? 1.0 : 0.0;
        }
        for (int step = 0; step < kNewtonSteps; ++step) {
            std::int64_t left = 0;
            for (int i = 0; i < kLanes; ++i) {
                const double x = root[i], to = x - phi(i, x) / phi.slope(i, x);
                const double low = to > 0.0 ? to : 0.0, next = low < 1.0 ? low : 1.0;
                const double moved = std::abs(next - x);
                const bool going = (open[i] & falling[i]) != 0;
                root[i] = going ? next : x;
                open[i] = (going & (moved < kRootTolerance)) ? 0 : open[i];
                left += open[i] & falling[i];
            }
            if (left == 0) break;
        }
    });
    for (int i = 0; i < edges.count; ++i) {
        if (open[i] != 0)
            root[i] = rootInUnitInterval(phi.c0[i], far[i], [&](double x) { return phi(i, x); });
        distance[i] = float(reach[i] * root[i]);
    }
}

} // namespace vdbtet
