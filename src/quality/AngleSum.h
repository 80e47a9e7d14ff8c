/// @file AngleSum.h
/// Sums up the dihedral angles of very many tets.
#pragma once

#include "simd/Isa.h"

#include <vdbtet/Quality.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Extremes, histogram and percentiles of angles; tets are collected and judged a batch at a time.
class AngleSum {
public:
    explicit AngleSum(Isa isa = bestIsa()) : mIsa(isa) {}

    /// Add the six angles of a tet.
    void add(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
             const openvdb::Vec3d& d) {
        int row = 0;
        for (const openvdb::Vec3d* p : {&a, &b, &c, &d}) {
            for (int axis = 0; axis < 3; ++axis) mBatch[row++][mBatched] = (*p)[axis];
        }
        if (++mBatched == kBatch) flush();
    }

    /// Add @a count tets of these angles, in degrees, which must be multiples of 5.
    void addKnown(const std::array<int, 6>& degrees, std::int64_t count) {
        for (const int angle : degrees) mKnown[std::size_t(angle / 5)] += count;
    }
    /// Add tets of the lattice itself.
    void addLatticeTets(std::int64_t count) { addKnown({60, 60, 60, 60, 90, 90}, count); }

    /// Take in all that @a other has seen.
    void add(AngleSum& other);

    /// Make this the sum of several, by a @a reduction that has least(double&), most(double&) and
    /// sum(std::int64_t*, std::size_t count): each makes a number that of all of them.
    template <typename Reduction>
    void reduce(Reduction& reduction) {
        flush();
        reduction.least(mMin);
        reduction.most(mMax);
        reduction.sum(mFine.data(), mFine.size());
        reduction.sum(mKnown.data(), mKnown.size());
    }

    AngleStats stats();
    AnglePercentiles percentiles();
    /// All angles, ascending; bins are as fine as AnglePercentiles are good.
    std::vector<AngleBin> bins();

private:
    static constexpr int kBatch = 64;
    static constexpr int kFineBins = 1024;

    void flush();

    Isa mIsa;
    double mMin = 1.0, mMax = -1.0; ///< of the signed squares of the cosines
    /// Measured angles by the signed squares of their cosines, in fine bins from -1 to 1. Of each the second
    /// count is of those at or beyond a multiple of 10 degrees that lies in the bin.
    std::array<std::int64_t, 2 * kFineBins> mFine{};
    std::array<std::int64_t, 36> mKnown{}; ///< angles of 0, 5, ... 175 degrees

    int mBatched = 0;
    double mBatch[12][kBatch]; ///< coordinates of the vertices
};

} // namespace vdbtet
