/// @file TetQuality.h
/// What optimisation takes for the quality of a tet.
///
/// The sine of the sharpest dihedral angle, squared, as no trigonometry is needed for that; obtuse angles
/// count for less, so that a target of 30 degrees asks for angles of at most 131.
#pragma once

#include "quality/Dihedral.h"
#include "simd/Isa.h"

#include <limits>

namespace vdbtet {

/// The weight of the sine of an obtuse angle, squared. A smaller one lets obtuse angles stall the rest.
constexpr double kObtuseWeight = 0.66 * 0.66;

/// Six times the volume, in cubed lattice units, below which a tet counts as inverted. Those of the lattice
/// have 1/2.
constexpr double kLeastVolume6 = 1e-6;

/// Squared sines: of the sharpest acute angle, and of the widest obtuse one; 1 where there is none.
struct BallQuality {
    double acute = 1.0, obtuse = 1.0;
    bool inverted = false;

    double quality() const {
        const double weighted = kObtuseWeight * obtuse;
        return inverted ? -1.0 : acute < weighted ? acute : weighted;
    }
};

/// What a ball must exceed to pass.
struct BallLimits {
    double quality;
    double acute, obtuse; ///< squared sines that must at least be kept
};

/// The same of some tet: its extreme signed squared cosines, see signedSquares().
struct TetAngles {
    double least, most; ///< of the widest and of the sharpest angle
    double volume6;
};

VDBTET_KERNEL inline TetAngles tetAngles(const Triple& a, const Triple& b, const Triple& c, const Triple& d) {
    double squares[6];
    signedSquares(a, b, c, d, squares);
    double least = squares[0], most = squares[0];
    for (int k = 1; k < 6; ++k) {
        least = squares[k] < least ? squares[k] : least;
        most = most < squares[k] ? squares[k] : most;
    }
    return {least, most, dot(b - a, cross(c - a, d - a))};
}

/// The squared sines of the sharpest acute angle and of the widest obtuse one.
VDBTET_KERNEL inline double acuteSine2(double most) { return 1.0 - (most > 0.0 ? most : 0.0); }
VDBTET_KERNEL inline double obtuseSine2(double least) { return 1.0 + (least < 0.0 ? least : 0.0); }

/// The quality of a tet: at most kObtuseWeight, and -1 for an inverted one.
VDBTET_KERNEL inline double tetQuality(const TetAngles& angles) {
    const double acute = acuteSine2(angles.most), obtuse = kObtuseWeight * obtuseSine2(angles.least);
    const double least = acute < obtuse ? acute : obtuse;
    return angles.volume6 > kLeastVolume6 ? least : -1.0;
}

} // namespace vdbtet
