/// @file AngleSum.cc
/// The judging of a batch.
#include "quality/AngleSum.h"

#include "quality/Dihedral.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

constexpr double kFinePerUnit = 512.0;

/// The fine bin of a signed square. Ascending, so only in the bin of an edge are there squares on both sides.
VDBTET_KERNEL inline int fineBin(double square, int bins) {
    const double bin = (square + 1.0) * kFinePerUnit, last = bins - 1;
    // Rounding may lead out at both ends, and the angles of a degenerate tet are not numbers.
    return int(bin > 0.0 ? bin < last ? bin : last : 0.0);
}

/// The multiples of 10 degrees in fine bins.
struct Edges {
    std::vector<double> square; ///< of the cosine of the one in a bin; below all where there is none
    std::vector<int> beyond;    ///< how many there are in the bins above, of smaller angles

    explicit Edges(int bins) : square(std::size_t(bins), -2.0), beyond(std::size_t(bins), 0) {
        for (int i = 1; i < 18; ++i) {
            const double cosine = std::cos(i * 10.0 / 57.295779513082320877);
            const double edge = cosine * std::abs(cosine);
            const int bin = fineBin(edge, bins);
            square[std::size_t(bin)] = edge;
            for (int below = 0; below < bin; ++below) ++beyond[std::size_t(below)];
        }
    }
};

const Edges& fineEdges() {
    static const Edges kEdges(2 * int(kFinePerUnit));
    return kEdges;
}

} // namespace

void AngleSum::flush() {
    const int count = mBatched;
    mBatched = 0;
    if (count == 0) return;
    // The rest of a batch repeats its first tet, and is not counted.
    for (auto& row : mBatch) std::fill(row + count, row + kBatch, row[0]);

    const double* edges = fineEdges().square.data();
    runOn(mIsa, [&]() VDBTET_KERNEL {
        constexpr int kAngles = 6 * kBatch;
        double squares[kAngles];
        int bins[kAngles];
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
        for (int i = 0; i < kAngles; ++i) bins[i] = fineBin(squares[i], kFineBins);
        for (int first = 0; first < kAngles; first += kBatch) {
            for (int i = first; i < first + count; ++i)
                ++mFine[std::size_t(2 * bins[i] + (squares[i] <= edges[bins[i]] ? 1 : 0))];
        }
    });
}

void AngleSum::add(AngleSum& other) {
    flush();
    other.flush();
    mMin = std::min(mMin, other.mMin);
    mMax = std::max(mMax, other.mMax);
    for (std::size_t i = 0; i < mFine.size(); ++i) mFine[i] += other.mFine[i];
    for (std::size_t i = 0; i < mKnown.size(); ++i) mKnown[i] += other.mKnown[i];
}

AngleStats AngleSum::stats() {
    flush();
    AngleStats stats;
    const Edges& edges = fineEdges();
    for (std::size_t bin = 0; bin < kFineBins; ++bin) {
        const auto before = std::size_t(edges.beyond[bin]);
        stats.histogram[before] += mFine[2 * bin];
        if (mFine[2 * bin + 1] != 0) stats.histogram[before + 1] += mFine[2 * bin + 1];
    }
    if (mMax >= mMin) {
        stats.min = angleOfSquare(mMax);
        stats.max = angleOfSquare(mMin);
    }
    for (std::size_t i = 0; i < mKnown.size(); ++i) {
        if (mKnown[i] == 0) continue;
        stats.histogram[i / 2] += mKnown[i];
        stats.min = std::min(stats.min, 5.0 * double(i));
        stats.max = std::max(stats.max, 5.0 * double(i));
    }
    return stats;
}

std::vector<AngleBin> AngleSum::bins() {
    flush();
    const auto angleAt = [](double bin) { return angleOfSquare(std::min(bin / kFinePerUnit, 2.0) - 1.0); };
    std::vector<AngleBin> bins;
    for (int bin = 0; bin < kFineBins; ++bin) {
        const std::int64_t count = mFine[2 * std::size_t(bin)] + mFine[2 * std::size_t(bin) + 1];
        if (count > 0) bins.push_back({angleAt(bin + 1.0), angleAt(bin), count});
    }
    for (std::size_t i = 0; i < mKnown.size(); ++i) {
        if (mKnown[i] > 0) bins.push_back({5.0 * double(i), 5.0 * double(i), mKnown[i]});
    }
    std::sort(bins.begin(), bins.end(),
              [](const AngleBin& a, const AngleBin& b) { return a.low + a.high < b.low + b.high; });
    return bins;
}

AnglePercentiles AngleSum::percentiles() {
    const AngleStats all = stats();
    const std::vector<AngleBin> ascending = bins();
    std::int64_t total = 0;
    for (const AngleBin& bin : ascending) total += bin.count;
    /// Where so many angles have been passed; those of a bin are taken to be spread evenly.
    const auto angleAfter = [&](double count) {
        for (const AngleBin& bin : ascending) {
            if (count <= double(bin.count))
                return std::clamp(bin.low + (bin.high - bin.low) * count / double(bin.count), all.min,
                                  all.max);
            count -= double(bin.count);
        }
        return all.max;
    };
    AnglePercentiles result;
    for (std::size_t i = 0; i < AnglePercentiles::kPercents.size() && total > 0; ++i) {
        const double count = AnglePercentiles::kPercents[i] / 100.0 * double(total);
        result.low[i] = angleAfter(count);
        result.high[i] = angleAfter(double(total) - count);
    }
    return result;
}

} // namespace vdbtet
