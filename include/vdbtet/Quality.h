/// @file Quality.h
/// Dihedral angles of tetrahedra.
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>

namespace vdbtet {

/// Extremes and histogram of dihedral angles, in degrees. Sums of several are exact, in any order.
struct AngleStats {
    double min = 180.0;
    double max = 0.0;
    /// histogram[i] counts the angles in [10 i, 10 (i + 1)); six angles a tet.
    std::array<std::int64_t, 18> histogram{};

    AngleStats& operator+=(const AngleStats& other);
};

/// The extremes of dihedral angles, in degrees.
struct AngleRange {
    double min = 180.0;
    double max = 0.0;
};

/// The tails of the distribution of dihedral angles, in degrees.
struct AnglePercentiles {
    static constexpr std::array<double, 3> kPercents{0.01, 0.1, 1.0};

    /// kPercents[i] percent of all angles are at most low[i], and as many at least high[i]: to within a fifth
    /// of a degree, but one degree from 80 to 100.
    std::array<double, 3> low{}, high{};
};

/// How many dihedral angles there are between two, in degrees; where these are equal, how many there are of
/// exactly that.
struct AngleBin {
    double low = 0.0, high = 0.0;
    std::int64_t count = 0;
};

/// @return the six dihedral angles of the tet (a,b,c,d) in degrees, at its edges ab, ac, ad, bc, bd, cd.
/// @note An inverted tet shows the angles of its mirror image: look at signedVolume6() too.
std::array<double, 6> dihedralAngles(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                                     const openvdb::Vec3d& c, const openvdb::Vec3d& d);

/// @return six times the signed volume, det(b-a, c-a, d-a).
double signedVolume6(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                     const openvdb::Vec3d& d);

} // namespace vdbtet
