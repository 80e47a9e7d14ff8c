/// @file OctahedronBatch.cc
/// The judging in lanes.
#include "flips/OctahedronBatch.h"

#include "flips/Slices.h"
#include "quality/Dihedral.h"

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

VDBTET_KERNEL inline double lesser(double a, double b) { return a < b ? a : b; }
VDBTET_KERNEL inline double greater(double a, double b) { return a < b ? b : a; }

double cosineOf(double square) { return std::copysign(std::sqrt(std::abs(square)), square); }

} // namespace

template <int kSlice, int kTet>
VDBTET_KERNEL inline void OctahedronBatch::judgeTet() {
    constexpr const auto& kTetVertices = bcc::kSliceTets[kSlice][kTet];
    for (int i = 0; i < kLanes; ++i) {
        const auto vertex = [&](int v) VDBTET_KERNEL {
            const auto& p = mAt[kTetVertices[v]];
            return Triple{p[0][i], p[1][i], p[2][i]};
        };
        const Triple a = vertex(0), b = vertex(1), c = vertex(2), d = vertex(3);
        double s[6];
        signedSquares(a, b, c, d, s);
        const double least = lesser(lesser(lesser(s[0], s[1]), lesser(s[2], s[3])), lesser(s[4], s[5]));
        const double most = greater(greater(greater(s[0], s[1]), greater(s[2], s[3])), greater(s[4], s[5]));
        const double volume = dot(b - a, cross(c - a, d - a));
        mLeast[kSlice][i] = kTet == 0 ? least : lesser(mLeast[kSlice][i], least);
        mMost[kSlice][i] = kTet == 0 ? most : greater(mMost[kSlice][i], most);
        mVolume[kSlice][i] = kTet == 0 ? volume : lesser(mVolume[kSlice][i], volume);
    }
}

template <int kSlice>
VDBTET_KERNEL inline void OctahedronBatch::judgeSlice() {
    judgeTet<kSlice, 0>();
    judgeTet<kSlice, 1>();
    judgeTet<kSlice, 2>();
    judgeTet<kSlice, 3>();
}

void OctahedronBatch::judge() {
    runOn(mIsa, [&]() VDBTET_KERNEL {
        judgeSlice<bcc::S>();
        judgeSlice<bcc::SliceA>();
        judgeSlice<bcc::SliceB>();
        for (int i = 0; i < kLanes; ++i) {
            const double least = mLeast[0][i], most = mMost[0][i];
            const bool some = (mLeast[1][i] > least) | (mMost[1][i] < most) | (mLeast[2][i] > least) |
                              (mMost[2][i] < most) | !(mVolume[0][i] > 0.0);
            mMayGain[i] = some ? 1 : 0;
        }
    });
}

double OctahedronBatch::worthOf(bcc::Slice slice, int lane) const {
    SliceQuality quality;
    quality.inverted = !(mVolume[slice][lane] > 0.0);
    quality.minCos = cosineOf(mLeast[slice][lane]);
    quality.maxCos = cosineOf(mMost[slice][lane]);
    return worth(quality);
}

} // namespace vdbtet
