/// @file PoorTets.h
/// Finds the tets that are not good enough, a batch at a time.
#pragma once

#include "optimize/TetQuality.h"
#include "simd/Isa.h"

#include <openvdb/Types.h>

#include <array>

namespace vdbtet {

class PoorTets {
public:
    /// @param quality  what a tet must reach, see TetQuality.h
    explicit PoorTets(double quality, Isa isa = bestIsa()) : mTarget(quality), mIsa(isa) {}

    /// @brief Judge a tet, now or later.
    /// @param ids       of its vertices, for the caller
    /// @param onPoor    called with the ids of each poor tet, of this one or of others added before
    template <typename OnPoor>
    void add(const std::array<int, 4>& ids, const std::array<openvdb::Vec3d, 4>& vertices, OnPoor&& onPoor) {
        for (int v = 0; v < 4; ++v) {
            for (int axis = 0; axis < 3; ++axis) mPlaces[3 * v + axis][mCount] = vertices[v][axis];
        }
        mIds[mCount] = ids;
        if (++mCount == kBatch) flush(onPoor);
    }

    /// Judge those that are left.
    template <typename OnPoor>
    void flush(OnPoor&& onPoor) {
        judge();
        for (int i = 0; i < mCount; ++i) {
            if (mQuality[i] < mTarget) onPoor(mIds[i]);
        }
        mCount = 0;
    }

    /// The signed squared cosines of the widest and of the sharpest angle judged.
    double least() const { return mLeast; }
    double most() const { return mMost; }

private:
    static constexpr int kBatch = 64;

    void judge();

    double mTarget;
    Isa mIsa;
    double mLeast = 1.0, mMost = -1.0;
    int mCount = 0;
    std::array<std::array<int, 4>, kBatch> mIds;
    double mPlaces[12][kBatch];
    double mQuality[kBatch];
};

} // namespace vdbtet
