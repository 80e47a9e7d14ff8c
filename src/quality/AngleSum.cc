/// @file AngleSum.cc
/// The judging of a batch.
#include "quality/AngleSum.h"

#include "quality/Dihedral.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

/// The cosines of 10, 20, ... 170 degrees.
const std::array<double, 17>& binEdges() {
    static const std::array<double, 17> kEdges = [] {
        std::array<double, 17> edges;
        for (int i = 0; i < 17; ++i) edges[i] = std::cos((i + 1) * 10.0 / 57.295779513082320877);
        return edges;
    }();
    return kEdges;
}

} // namespace

void AngleSum::flush() {
    const int count = mBatched;
    mBatched = 0;
    if (count == 0) return;
    // The rest of a batch repeats its first tet, and is not counted.
    for (auto& row : mBatch) std::fill(row + count, row + kBatch, row[0]);
    mAngles += 6 * count;
    const auto& edges = binEdges();

    runOn(mIsa, [&]() VDBTET_KERNEL {
        double cosines[6][kBatch];
        for (int i = 0; i < kBatch; ++i) {
            const auto vertex = [&](int v) VDBTET_KERNEL {
                return Triple{mBatch[3 * v][i], mBatch[3 * v + 1][i], mBatch[3 * v + 2][i]};
            };
            double six[6];
            dihedralCosines(vertex(0), vertex(1), vertex(2), vertex(3), six);
            for (int k = 0; k < 6; ++k) cosines[k][i] = six[k];
        }
        constexpr int kLanes = 16;
        double least[kLanes], most[kLanes];
        for (int i = 0; i < kLanes; ++i) least[i] = mMinCos, most[i] = mMaxCos;
        for (const auto& row : cosines) {
            for (int first = 0; first < kBatch; first += kLanes) {
                for (int i = 0; i < kLanes; ++i) {
                    const double cosine = row[first + i];
                    least[i] = cosine < least[i] ? cosine : least[i];
                    most[i] = most[i] < cosine ? cosine : most[i];
                }
            }
        }
        mMinCos = *std::min_element(least, least + kLanes);
        mMaxCos = *std::max_element(most, most + kLanes);
        for (int bin = 0; bin < kBins - 1; ++bin) {
            const double edge = edges[bin];
            std::int64_t beyond = 0, repeated = 0;
            for (const auto& row : cosines) {
                for (int i = 0; i < kBatch; ++i) beyond += row[i] <= edge ? 1 : 0;
                repeated += row[0] <= edge ? 1 : 0;
            }
            mBeyond[bin] += beyond - (kBatch - count) * repeated;
        }
    });
}

void AngleSum::add(AngleSum& other) {
    flush();
    other.flush();
    mMinCos = std::min(mMinCos, other.mMinCos);
    mMaxCos = std::max(mMaxCos, other.mMaxCos);
    mAngles += other.mAngles;
    for (std::size_t i = 0; i < mBeyond.size(); ++i) mBeyond[i] += other.mBeyond[i];
    mLatticeTets += other.mLatticeTets;
}

AngleStats AngleSum::stats() {
    flush();
    AngleStats stats;
    std::int64_t before = mAngles;
    for (int bin = 0; bin < kBins; ++bin) {
        const std::int64_t beyond = bin < kBins - 1 ? mBeyond[bin] : 0;
        stats.histogram[bin] = before - beyond;
        before = beyond;
    }
    stats.histogram[6] += 4 * mLatticeTets;
    stats.histogram[9] += 2 * mLatticeTets;
    if (mMaxCos >= mMinCos) {
        stats.min = angleOf(mMaxCos);
        stats.max = angleOf(mMinCos);
    }
    if (mLatticeTets > 0) {
        stats.min = std::min(stats.min, 60.0);
        stats.max = std::max(stats.max, 90.0);
    }
    return stats;
}

} // namespace vdbtet
