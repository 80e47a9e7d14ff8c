/// @file AngleSum.cc
/// The judging of a batch.
#include "quality/AngleSum.h"

#include "quality/Dihedral.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

/// The signed squares of the cosines of 10, 20, ... 170 degrees.
const std::array<double, 17>& binEdges() {
    static const std::array<double, 17> kEdges = [] {
        std::array<double, 17> edges;
        for (int i = 0; i < 17; ++i) {
            const double cosine = std::cos((i + 1) * 10.0 / 57.295779513082320877);
            edges[i] = cosine * std::abs(cosine);
        }
        return edges;
    }();
    return kEdges;
}

double cosineOf(double square) { return std::copysign(std::sqrt(std::abs(square)), square); }

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
        constexpr int kAngles = 6 * kBatch;
        double squares[kAngles];
        for (int i = 0; i < kBatch; ++i) {
            const auto vertex = [&](int v) VDBTET_KERNEL {
                return Triple{mBatch[3 * v][i], mBatch[3 * v + 1][i], mBatch[3 * v + 2][i]};
            };
            double six[6];
            signedSquares(vertex(0), vertex(1), vertex(2), vertex(3), six);
            for (int k = 0; k < 6; ++k) squares[k * kBatch + i] = six[k];
        }
        double least[kBatch], most[kBatch];
        for (int i = 0; i < kBatch; ++i) least[i] = most[i] = squares[i];
        for (int first = kBatch; first < kAngles; first += kBatch) {
            for (int i = 0; i < kBatch; ++i) {
                const double square = squares[first + i];
                least[i] = square < least[i] ? square : least[i];
                most[i] = most[i] < square ? square : most[i];
            }
        }
        // Halve until one is left.
        for (int half = kBatch / 2; half > 0; half /= 2) {
            for (int i = 0; i < half; ++i) {
                least[i] = least[i + half] < least[i] ? least[i + half] : least[i];
                most[i] = most[i] < most[i + half] ? most[i + half] : most[i];
            }
        }
        mMin = std::min(mMin, least[0]);
        mMax = std::max(mMax, most[0]);
        for (int bin = 0; bin < kBins - 1; ++bin) {
            const double edge = edges[bin];
            std::int64_t beyond = 0, repeated = 0;
            for (int i = 0; i < kAngles; ++i) beyond += squares[i] <= edge ? 1 : 0;
            for (int k = 0; k < 6; ++k) repeated += squares[k * kBatch] <= edge ? 1 : 0;
            mBeyond[bin] += beyond - (kBatch - count) * repeated;
        }
    });
}

void AngleSum::add(AngleSum& other) {
    flush();
    other.flush();
    mMin = std::min(mMin, other.mMin);
    mMax = std::max(mMax, other.mMax);
    mAngles += other.mAngles;
    for (std::size_t i = 0; i < mBeyond.size(); ++i) mBeyond[i] += other.mBeyond[i];
    for (std::size_t i = 0; i < mKnown.size(); ++i) mKnown[i] += other.mKnown[i];
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
    if (mMax >= mMin) {
        stats.min = angleOf(cosineOf(mMax));
        stats.max = angleOf(cosineOf(mMin));
    }
    for (std::size_t i = 0; i < mKnown.size(); ++i) {
        if (mKnown[i] == 0) continue;
        stats.histogram[i / 2] += mKnown[i];
        stats.min = std::min(stats.min, 5.0 * double(i));
        stats.max = std::max(stats.max, 5.0 * double(i));
    }
    return stats;
}

} // namespace vdbtet
