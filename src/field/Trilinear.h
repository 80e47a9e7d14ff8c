/// @file Trilinear.h
/// Trilinear interpolation.
#pragma once

namespace vdbtet {

/// @return the trilinear interpolation of corner values @a p (p[4i+2j+k] at corner (i,j,k)) at (x,y,z) in
/// [0,1]^3.
/// @details Exact at the corners, and never of the wrong sign where all corners agree.
inline double trilinear(const double (&p)[8], double x, double y, double z) {
    auto mix = [](double a, double b, double w) { return (1.0 - w) * a + w * b; };
    return mix(mix(mix(p[0], p[1], z), mix(p[2], p[3], z), y), mix(mix(p[4], p[5], z), mix(p[6], p[7], z), y),
               x);
}

} // namespace vdbtet
