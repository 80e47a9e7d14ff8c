/// @file Slices.cc
/// Qualities one at a time and in lanes.
#include "flips/Slices.h"

#include "quality/Dihedral.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

VDBTET_KERNEL inline double lesser(double a, double b) { return a < b ? a : b; }
VDBTET_KERNEL inline double greater(double a, double b) { return a < b ? b : a; }
VDBTET_KERNEL inline double least(const double (&six)[6]) {
    return lesser(lesser(lesser(six[0], six[1]), lesser(six[2], six[3])), lesser(six[4], six[5]));
}
VDBTET_KERNEL inline double most(const double (&six)[6]) {
    return greater(greater(greater(six[0], six[1]), greater(six[2], six[3])), greater(six[4], six[5]));
}

/// The octahedra of active spines, as many as there are lanes.
struct ActiveBatch {
    static constexpr int kLanes = 16;

    double at[5][3][kLanes] = {}; ///< the inside end of the spine, then its ring
    double side[kLanes] = {};     ///< 1 where that is the upper end, else -1
    /// By slice, A and B.
    double minCos[2][kLanes], maxCos[2][kLanes], minVolume[2][kLanes];
    std::int64_t clear[kLanes], slicesB[kLanes]; ///< whether cosines decide alone, and how

    void set(int lane, const LocalVertices& vertices, const LocalOctahedron& octahedron) {
        const int end = vertices.interior(octahedron[1]) ? 1 : 0;
        side[lane] = end == 1 ? 1.0 : -1.0;
        for (int v = 0; v < 5; ++v) {
            const Vec3d position = vertices.position(octahedron[v == 0 ? end : v + 1]);
            for (int axis = 0; axis < 3; ++axis) at[v][axis][lane] = position[axis];
        }
    }

    SliceQuality quality(int slice, int lane) const {
        return {minVolume[slice][lane] <= 0.0, minCos[slice][lane], maxCos[slice][lane]};
    }

    /// Judge a slice whose diagonal starts at the ring's vertex @a kFrom.
    template <int kSlice, int kFrom>
    VDBTET_KERNEL inline void judge() {
        for (int i = 0; i < kLanes; ++i) {
            const auto ring = [&](int n) VDBTET_KERNEL {
                const auto& p = at[1 + (kFrom + n) % 4];
                return Triple{p[0][i], p[1][i], p[2][i]};
            };
            const Triple end{at[0][0][i], at[0][1][i], at[0][2][i]};
            const Triple from = ring(0), second = ring(1), third = ring(2), fourth = ring(3);
            double one[6], two[6];
            dihedralCosines(from, second, third, end, one);
            dihedralCosines(from, third, fourth, end, two);
            minCos[kSlice][i] = lesser(least(one), least(two));
            maxCos[kSlice][i] = greater(most(one), most(two));
            const double volume1 = side[i] * dot(cross(second - from, third - from), end - from),
                         volume2 = side[i] * dot(cross(third - from, fourth - from), end - from);
            minVolume[kSlice][i] = lesser(volume1, volume2);
        }
    }

    /// Decide as better() does where neither a tie nor an inverted tet is near.
    VDBTET_KERNEL inline void decide() {
        // 1e-6 of a cosine is more than any tie of angles, and than the rounding of kMinAngle's cosine.
        constexpr double kClear = 1e-6, kMinCos = 0.98002895910;
        for (int i = 0; i < kLanes; ++i) {
            const double minA = minCos[0][i], minB = minCos[1][i], maxA = maxCos[0][i], maxB = maxCos[1][i];
            const bool upright = (minVolume[0][i] > 0.0) & (minVolume[1][i] > 0.0);
            const double apartMax = std::abs(maxA - maxB), apartMin = std::abs(minA - minB),
                         fromA = std::abs(maxA - kMinCos), fromB = std::abs(maxB - kMinCos);
            const bool distinct =
                (apartMax > kClear) & (apartMin > kClear) & (fromA > kClear) & (fromB > kClear);
            const bool fine = (maxA < kMinCos) & (maxB < kMinCos);
            const std::int64_t byMax = minB > minA ? 1 : 0, byMin = maxB < maxA ? 1 : 0;
            clear[i] = (upright & distinct) ? 1 : 0;
            slicesB[i] = fine ? byMax : byMin;
        }
    }

    void judge(Isa isa) {
        // Slice A has the tets 2 3 4 and 2 4 5 of the ring, slice B 5 2 3 and 5 3 4.
        runOn(isa, [&]() VDBTET_KERNEL {
            judge<0, 0>();
            judge<1, 3>();
            decide();
        });
    }
};

} // namespace

SliceQuality sliceQuality(const LocalVertices& vertices, const LocalOctahedron& octahedron,
                          bcc::Slice slice) {
    SliceQuality quality;
    for (const auto& tet : bcc::kSliceTets[slice]) {
        int manifold = 0;
        bool outside = false;
        Vec3d p[4];
        for (int i = 0; i < 4; ++i) {
            const int local = octahedron[tet[i]];
            p[i] = vertices.position(local);
            manifold += vertices.manifold(local);
            outside = outside || vertices.state(local) == State::Outside;
        }
        if (outside || manifold == 4) continue;
        // An inverted tet can show fine angles by the unsigned formula.
        if (signedVolume6(p[0], p[1], p[2], p[3]) <= 0.0) quality.inverted = true;
        for (double cosine : dihedralCosines(p[0], p[1], p[2], p[3])) {
            quality.minCos = std::min(quality.minCos, cosine);
            quality.maxCos = std::max(quality.maxCos, cosine);
        }
    }
    return quality;
}

bool better(const SliceQuality& a, const SliceQuality& b) {
    if (a.inverted != b.inverted) return b.inverted;
    const double minA = angleOf(a.maxCos), maxA = angleOf(a.minCos), minB = angleOf(b.maxCos),
                 maxB = angleOf(b.minCos);
    const bool sameMin = std::abs(minA - minB) <= kTieAngle, sameMax = std::abs(maxA - maxB) <= kTieAngle;
    if (minA > kMinAngle && minB > kMinAngle) return sameMax ? !sameMin && minA > minB : maxA < maxB;
    return sameMin ? !sameMax && maxA < maxB : minA > minB;
}

double worth(const SliceQuality& quality) {
    constexpr double kObtuse = 0.54; // 39 degrees from 180 are as bad as 21 from 0
    if (quality.inverted) return 0.0;
    return std::min(angleOf(quality.maxCos), kObtuse * (180.0 - angleOf(quality.minCos)));
}

void chooseActiveSlices(const LocalVertices& vertices, const std::vector<LocalOctahedron>& octahedra,
                        SliceRule rule, std::vector<bcc::Slice>& slices, Isa isa) {
    slices.clear();
    ActiveBatch batch;
    for (std::size_t first = 0; first < octahedra.size(); first += ActiveBatch::kLanes) {
        const int count = int(std::min<std::size_t>(ActiveBatch::kLanes, octahedra.size() - first));
        for (int lane = 0; lane < count; ++lane)
            batch.set(lane, vertices, octahedra[first + std::size_t(lane)]);
        batch.judge(isa);
        for (int lane = 0; lane < count; ++lane) {
            const SliceQuality a = batch.quality(0, lane), b = batch.quality(1, lane);
            const bool slicesB = rule == SliceRule::Worth ? worth(b) > worth(a) + kTieAngle
                                 : batch.clear[lane]      ? batch.slicesB[lane] != 0
                                                          : better(b, a);
            slices.push_back(slicesB ? bcc::SliceB : bcc::SliceA);
        }
    }
}

} // namespace vdbtet
