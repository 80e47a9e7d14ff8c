/// @file Root.h
/// A bracketing root finder for cut points.
#pragma once

#include <cmath>

namespace vdbtet {

constexpr double kRootTolerance = 1e-10;
constexpr int kRootIterations = 100;

/// @return a root in [0,1] of @a f, given its values @a f0 and @a f1 at the ends, one of them negative and
/// the other not (Illinois: the secant that halves the weight of an end that stays).
template <typename Function>
double rootInUnitInterval(double f0, double f1, Function&& f) {
    if (f0 == 0.0) return 0.0;
    if (f1 == 0.0) return 1.0;
    const bool inside0 = f0 >= 0.0;
    double a = 0.0, b = 1.0, last = 2.0;
    int stayed = 0; // +1: end a stayed in the last step, -1: end b
    for (int i = 0; i < kRootIterations; ++i) {
        double x = (a * f1 - b * f0) / (f1 - f0);
        if (!(x > a && x < b)) x = 0.5 * (a + b);
        const double fx = f(x);
        if (fx == 0.0 || std::abs(x - last) < kRootTolerance || b - a < kRootTolerance) return x;
        last = x;
        if ((fx >= 0.0) == inside0) {
            a = x, f0 = fx;
            if (stayed == -1) f1 *= 0.5;
            stayed = -1;
        } else {
            b = x, f1 = fx;
            if (stayed == 1) f0 *= 0.5;
            stayed = 1;
        }
    }
    return 0.5 * (a + b);
}

/// Nearer to the middle of an edge, or another threshold on it, than about this fraction of it, a cut point
/// counts as there: rounding must not decide a tie.
constexpr double kMiddle = 1e-7;

/// @return how far from an end of an edge its cut point may be for that end to be the nearer one, as a
/// fraction of the edge.
/// @param end  the field there; @a tau holds for an end inside
constexpr double reachOf(double end, double tau) { return end >= 0.0 ? tau : 1.0 - tau; }

/// @return whether the cut point of an edge lies in its first part, or where that ends; all values of the
/// field at: the first end, the end of that part, the other end.
inline bool cutInFirstPart(double first, double middle, double second) {
    if (std::abs(middle) <= kMiddle * std::abs(second - first)) return true;
    return (first >= 0.0) != (middle >= 0.0);
}

/// @return the distance from the nearer end of an edge to its cut point, in [0, @a reach] of the edge.
/// @param near  the field's value at that end; @a f gives it at a fraction of the edge from there
template <typename Function>
float distanceToCut(double near, double reach, Function&& f) {
    const double middle = f(reach);
    // By the rule for ties the cut point may lie just beyond.
    if ((near >= 0.0) == (middle >= 0.0)) return float(reach);
    return float(reach * rootInUnitInterval(near, middle, [&](double s) { return f(reach * s); }));
}

} // namespace vdbtet
