/// @file Dihedral.h
/// Dihedral angles from face normals (paper, equation (16)).
#pragma once

#include "simd/Isa.h"

#include <openvdb/Types.h>

#include <array>
#include <cmath>

namespace vdbtet {

struct Triple {
    double x, y, z;
};
VDBTET_KERNEL inline Triple operator-(const Triple& a, const Triple& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
VDBTET_KERNEL inline Triple cross(const Triple& a, const Triple& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
VDBTET_KERNEL inline double dot(const Triple& a, const Triple& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The cosines of the dihedral angles at the edges ab, ac, ad, bc, bd, cd.
VDBTET_KERNEL inline void dihedralCosines(const Triple& a, const Triple& b, const Triple& c, const Triple& d,
                                          double (&cosines)[6]) {
    // Normals of the faces opposite to a, b, c, d, all outward or all inward.
    const Triple ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b;
    const Triple na = cross(bc, bd), nb = cross(ad, ac), nc = cross(ab, ad), nd = cross(ac, ab);
    const double ia = 1.0 / std::sqrt(dot(na, na)), ib = 1.0 / std::sqrt(dot(nb, nb)),
                 ic = 1.0 / std::sqrt(dot(nc, nc)), id = 1.0 / std::sqrt(dot(nd, nd));
    cosines[0] = -dot(nc, nd) * ic * id;
    cosines[1] = -dot(nb, nd) * ib * id;
    cosines[2] = -dot(nb, nc) * ib * ic;
    cosines[3] = -dot(na, nd) * ia * id;
    cosines[4] = -dot(na, nc) * ia * ic;
    cosines[5] = -dot(na, nb) * ia * ib;
}

/// The same squared, with the cosine's sign: they sort as the cosines do, and take one division instead of
/// four and as many roots.
VDBTET_KERNEL inline void signedSquares(const Triple& a, const Triple& b, const Triple& c, const Triple& d,
                                        double (&squares)[6]) {
    const Triple ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b;
    const Triple na = cross(bc, bd), nb = cross(ad, ac), nc = cross(ab, ad), nd = cross(ac, ab);
    const double aa = dot(na, na), bb = dot(nb, nb), cc = dot(nc, nc), dd = dot(nd, nd);
    const double aabb = aa * bb, ccdd = cc * dd, inverse = 1.0 / (aabb * ccdd);
    const double cosines[6] = {dot(nc, nd), dot(nb, nd), dot(nb, nc), dot(na, nd), dot(na, nc), dot(na, nb)};
    squares[0] = -cosines[0] * std::abs(cosines[0]) * (aabb * inverse);
    squares[1] = -cosines[1] * std::abs(cosines[1]) * (aa * cc * inverse);
    squares[2] = -cosines[2] * std::abs(cosines[2]) * (aa * dd * inverse);
    squares[3] = -cosines[3] * std::abs(cosines[3]) * (bb * cc * inverse);
    squares[4] = -cosines[4] * std::abs(cosines[4]) * (bb * dd * inverse);
    squares[5] = -cosines[5] * std::abs(cosines[5]) * (ccdd * inverse);
}

inline std::array<double, 6> dihedralCosines(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                                             const openvdb::Vec3d& c, const openvdb::Vec3d& d) {
    const auto triple = [](const openvdb::Vec3d& v) { return Triple{v.x(), v.y(), v.z()}; };
    double six[6];
    dihedralCosines(triple(a), triple(b), triple(c), triple(d), six);
    return {six[0], six[1], six[2], six[3], six[4], six[5]};
}

/// @return the angle in degrees of a cosine that rounding may have taken out of [-1,1].
double angleOf(double cosine);

/// The same of its signed square.
double angleOfSquare(double square);

} // namespace vdbtet
