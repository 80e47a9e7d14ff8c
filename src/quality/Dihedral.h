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

inline std::array<double, 6> dihedralCosines(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                                             const openvdb::Vec3d& c, const openvdb::Vec3d& d) {
    const auto triple = [](const openvdb::Vec3d& v) { return Triple{v.x(), v.y(), v.z()}; };
    double cosines[6];
    dihedralCosines(triple(a), triple(b), triple(c), triple(d), cosines);
    return {cosines[0], cosines[1], cosines[2], cosines[3], cosines[4], cosines[5]};
}

/// @return the angle in degrees of a cosine that rounding may have taken out of [-1,1].
double angleOf(double cosine);

} // namespace vdbtet
