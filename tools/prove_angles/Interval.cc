/// @file Interval.cc
/// The cosine of a bound in degrees.
#include "Interval.h"

namespace vdbtet::proof {

Interval cosineOfDegrees(const Interval& degrees) {
    const Interval pi(0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1);
    const Interval squared = square(degrees * pi / 180.0);
    // From the fourth term on terms fall for angles up to pi, and their signs alternate: what is left out is
    // less than the first term left out.
    constexpr int kTerms = 20;
    Interval sum(0.0), term(1.0);
    for (int k = 0; k < kTerms; ++k) {
        sum += k % 2 == 0 ? term : -term;
        term = term * squared / double((2 * k + 1) * (2 * k + 2));
    }
    return sum + Interval(-term.upper(), term.upper());
}

} // namespace vdbtet::proof
