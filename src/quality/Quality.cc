/// @file Quality.cc
/// The public functions on single tets.
#include <vdbtet/Quality.h>

#include "quality/Dihedral.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

using openvdb::Vec3d;

AngleStats& AngleStats::operator+=(const AngleStats& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    for (size_t i = 0; i < histogram.size(); ++i) histogram[i] += other.histogram[i];
    return *this;
}

double angleOf(double cosine) {
    constexpr double kDegrees = 57.295779513082320877; // 180 / pi
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees;
}

double angleOfSquare(double square) { return angleOf(std::copysign(std::sqrt(std::abs(square)), square)); }

std::array<double, 6> dihedralAngles(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    std::array<double, 6> angles = dihedralCosines(a, b, c, d);
    for (double& angle : angles) angle = angleOf(angle);
    return angles;
}

double signedVolume6(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return (b - a).cross(c - a).dot(d - a);
}

} // namespace vdbtet
