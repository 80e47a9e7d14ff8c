/// @file Quality.cc
/// Dihedral angles from face normals (paper, equation (16)).
#include <vdbtet/Quality.h>

#include "emit/Angles.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

constexpr double kDegrees = 57.295779513082320877; // 180 / pi

/// The cosines of the dihedral angles at the edges ab, ac, ad, bc, bd, cd.
std::array<double, 6> dihedralCosines(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    // Normals of the faces opposite to a, b, c, d, all outward or all inward.
    const Vec3d ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b;
    const Vec3d n[4] = {bc.cross(bd), ad.cross(ac), ab.cross(ad), ac.cross(ab)};
    double inverse[4];
    for (int i = 0; i < 4; ++i) inverse[i] = 1.0 / std::sqrt(n[i].dot(n[i]));
    const auto cosine = [&](int i, int j) { return -n[i].dot(n[j]) * inverse[i] * inverse[j]; };
    return {cosine(2, 3), cosine(1, 3), cosine(1, 2), cosine(0, 3), cosine(0, 2), cosine(0, 1)};
}

double degrees(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees; }

/// The cosines of 10, 20, ... 170 degrees.
const std::array<double, 17>& binEdges() {
    static const std::array<double, 17> kEdges = [] {
        std::array<double, 17> edges;
        for (int i = 0; i < 17; ++i) edges[i] = std::cos((i + 1) * 10.0 / kDegrees);
        return edges;
    }();
    return kEdges;
}

int binOf(double cosine) {
    const auto& edges = binEdges();
    int bin = 0;
    for (double edge : edges) bin += cosine <= edge;
    return bin;
}

} // namespace

AngleStats& AngleStats::operator+=(const AngleStats& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    for (size_t i = 0; i < histogram.size(); ++i) histogram[i] += other.histogram[i];
    return *this;
}

std::array<double, 6> dihedralAngles(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    std::array<double, 6> angles = dihedralCosines(a, b, c, d);
    for (double& angle : angles) angle = degrees(angle);
    return angles;
}

double signedVolume6(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return (b - a).cross(c - a).dot(d - a);
}

void AngleSum::add(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    for (double cosine : dihedralCosines(a, b, c, d)) {
        mMinCos = std::min(mMinCos, cosine);
        mMaxCos = std::max(mMaxCos, cosine);
        ++mHistogram[binOf(cosine)];
    }
}

AngleSum& AngleSum::operator+=(const AngleSum& other) {
    mMinCos = std::min(mMinCos, other.mMinCos);
    mMaxCos = std::max(mMaxCos, other.mMaxCos);
    for (size_t i = 0; i < mHistogram.size(); ++i) mHistogram[i] += other.mHistogram[i];
    mLatticeTets += other.mLatticeTets;
    return *this;
}

AngleStats AngleSum::stats() const {
    AngleStats stats;
    stats.histogram = mHistogram;
    stats.histogram[6] += 4 * mLatticeTets;
    stats.histogram[9] += 2 * mLatticeTets;
    if (mMaxCos >= mMinCos) {
        stats.min = degrees(mMaxCos);
        stats.max = degrees(mMinCos);
    }
    if (mLatticeTets > 0) {
        stats.min = std::min(stats.min, 60.0);
        stats.max = std::max(stats.max, 90.0);
    }
    return stats;
}

} // namespace vdbtet
