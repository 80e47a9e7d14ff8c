/// @file Interval.h
/// Intervals of doubles that are rounded outward, so that they hold what real arithmetic would give.
#pragma once

#include <boost/numeric/interval/arith.hpp>
#include <boost/numeric/interval/arith2.hpp>
#include <boost/numeric/interval/checking.hpp>
#include <boost/numeric/interval/interval.hpp>
#include <boost/numeric/interval/policies.hpp>
#include <boost/numeric/interval/utility.hpp>

#include <cfloat>
#include <cmath>

namespace vdbtet::proof {

static_assert(FLT_EVAL_METHOD == 0, "a double must be rounded to double after each operation");

/// @brief The rounding policy of our intervals: to nearest, then at least one double further.
/// @details No rounding mode is switched, so no option of the compiler, no library and no thread can be in
/// the wrong one. Why a double further: for 2^e <= |x| < 2^(e+1), |x| kStep is rounded to at least 2^(e-53)
/// (1 + 2^-52), which is more than half the distance 2^(e-52) to the next double; and for x too small to be
/// normal the smallest normal number is.
struct Outward {
    using unprotected_rounding = Outward;

    static double above(double x) { return x + (kStep * std::abs(x) + DBL_MIN); }
    static double below(double x) { return x - (kStep * std::abs(x) + DBL_MIN); }

    static double add_down(double x, double y) { return below(x + y); }
    static double add_up(double x, double y) { return above(x + y); }
    static double sub_down(double x, double y) { return below(x - y); }
    static double sub_up(double x, double y) { return above(x - y); }
    static double mul_down(double x, double y) { return below(x * y); }
    static double mul_up(double x, double y) { return above(x * y); }
    static double div_down(double x, double y) { return below(x / y); }
    static double div_up(double x, double y) { return above(x / y); }
    static double sqrt_down(double x) { return std::fmax(0.0, below(std::sqrt(x))); }
    static double sqrt_up(double x) { return above(std::sqrt(x)); }
    static double median(double x, double y) { return 0.5 * (x + y); }
    static double conv_down(double x) { return x; }
    static double conv_up(double x) { return x; }

private:
    static constexpr double kStep = 0x1.0000000000001p-53;
};

using Interval = boost::numeric::interval<
    double,
    boost::numeric::interval_lib::policies<Outward, boost::numeric::interval_lib::checking_base<double>>>;

using boost::numeric::sqrt;
using boost::numeric::square;
inline double sqrt(double x) { return std::sqrt(x); }
inline double square(double x) { return x * x; }

/// @return the interval of all numbers that round to the double @a decimal, such as the decimal it was
/// written as.
inline Interval enclose(double decimal) { return {Outward::below(decimal), Outward::above(decimal)}; }

/// @return the cosine of an angle in degrees, of at most 180, by its power series: no library's cosine is
/// trusted.
Interval cosineOfDegrees(const Interval& degrees);

} // namespace vdbtet::proof
