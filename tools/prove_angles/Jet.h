/// @file Jet.h
/// An interval with the intervals of its partial derivatives: forward differentiation.
#pragma once

#include "Interval.h"

#include <array>

namespace vdbtet::proof {

/// All problems have at most so many parameters; those that have fewer leave the last ones fixed.
constexpr int kParameters = 4;

struct Jet {
    Interval value{0.0};
    std::array<Interval, kParameters> slope{}; ///< by parameter
    unsigned used = 0;                         ///< a bit for each parameter whose slope is not simply 0

    Jet() = default;
    Jet(double constant) : value(constant) {}

    /// Parameter number @a p itself.
    static Jet parameter(int p, const Interval& range) {
        Jet jet;
        jet.value = range;
        jet.slope[p] = 1.0;
        jet.used = 1u << p;
        return jet;
    }
    bool uses(int p) const { return (used >> p & 1) != 0; }
};

template <typename Slope>
Jet makeJet(const Interval& value, unsigned used, Slope&& slope) {
    Jet jet;
    jet.value = value;
    jet.used = used;
    for (int p = 0; p < kParameters; ++p) {
        if (jet.uses(p)) jet.slope[p] = slope(p);
    }
    return jet;
}

inline Jet operator+(const Jet& a, const Jet& b) {
    return makeJet(a.value + b.value, a.used | b.used, [&](int p) { return a.slope[p] + b.slope[p]; });
}
inline Jet operator-(const Jet& a, const Jet& b) {
    return makeJet(a.value - b.value, a.used | b.used, [&](int p) { return a.slope[p] - b.slope[p]; });
}
inline Jet operator-(const Jet& a) {
    return makeJet(-a.value, a.used, [&](int p) { return -a.slope[p]; });
}
inline Jet operator*(const Jet& a, const Jet& b) {
    return makeJet(a.value * b.value, a.used | b.used, [&](int p) {
        if (!b.uses(p)) return a.slope[p] * b.value;
        if (!a.uses(p)) return a.value * b.slope[p];
        return a.slope[p] * b.value + a.value * b.slope[p];
    });
}
inline Jet operator*(const Jet& a, double factor) {
    return makeJet(a.value * factor, a.used, [&](int p) { return a.slope[p] * factor; });
}
inline Jet operator/(const Jet& a, const Jet& b) {
    const Interval quotient = a.value / b.value;
    return makeJet(quotient, a.used | b.used,
                   [&](int p) { return (a.slope[p] - quotient * b.slope[p]) / b.value; });
}
inline Jet square(const Jet& a) {
    const Interval twice = a.value * 2.0;
    return makeJet(square(a.value), a.used, [&](int p) { return twice * a.slope[p]; });
}
inline Jet sqrt(const Jet& a) {
    const Interval root = sqrt(a.value), twice = root * 2.0;
    return makeJet(root, a.used, [&](int p) { return a.slope[p] / twice; });
}

} // namespace vdbtet::proof
