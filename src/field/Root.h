/// @file Root.h
/// A bracketing root finder for cut points.
#pragma once

#include <cmath>

namespace vdbtet {

/// @return a root in [0,1] of @a f, given its values @a f0 and @a f1 at the ends, one of them negative and
/// the other not (Illinois: the secant that halves the weight of an end that stays).
template <typename Function>
double rootInUnitInterval(double f0, double f1, Function&& f) {
    constexpr double kTolerance = 1e-10;
    constexpr int kMaxIterations = 100;
    const bool inside0 = f0 >= 0.0;
    if (f0 == 0.0) return 0.0;
    if (f1 == 0.0) return 1.0;
    double a = 0.0, b = 1.0, last = 2.0;
    int stayed = 0; // +1: end a stayed in the last step, -1: end b
    for (int i = 0; i < kMaxIterations; ++i) {
        double x = (a * f1 - b * f0) / (f1 - f0);
        if (!(x > a && x < b)) x = 0.5 * (a + b);
        const double fx = f(x);
        if (fx == 0.0 || std::abs(x - last) < kTolerance || b - a < kTolerance) return x;
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

} // namespace vdbtet
