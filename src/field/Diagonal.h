/// @file Diagonal.h
/// The trilinear field on a short edge of a voxel-centred lattice, where it is a cubic.
#pragma once

#include "simd/Isa.h"

namespace vdbtet {

/// The field along the line from a corner of a voxel-centred cube to its centre: at a fraction s of the whole
/// diagonal it is b0 (1-s)^3 + b1 s (1-s)^2 + b2 s^2 (1-s) + b3 s^3.
struct Diagonal {
    double b0, b1, b2, b3;

    /// @param p  the eight corner values, p[4i+2j+k] at corner (i,j,k); the line starts at p[0]
    static Diagonal of(const double (&p)[8]) { return {p[0], p[1] + p[2] + p[4], p[3] + p[5] + p[6], p[7]}; }

    /// @param t  0 at the corner, 1 at the centre
    double operator()(double t) const {
        const double s = 0.5 * t, r = 1.0 - s;
        return r * r * (r * b0 + s * b1) + s * s * (r * b2 + s * b3);
    }
};

/// @return the field at the centre of the cube.
VDBTET_KERNEL inline double centreValue(const double (&p)[8]) {
    return 0.125 * (((p[0] + p[1]) + (p[2] + p[3])) + ((p[4] + p[5]) + (p[6] + p[7])));
}

} // namespace vdbtet
