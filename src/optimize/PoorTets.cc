/// @file PoorTets.cc
/// The judging of a batch.
#include "optimize/PoorTets.h"

#include <algorithm>

namespace vdbtet {

void PoorTets::judge() {
    if (mCount == 0) return;
    for (auto& row : mPlaces) std::fill(row + mCount, row + kBatch, row[0]);
    runOn(mIsa, [&]() VDBTET_KERNEL {
        double least[kBatch], most[kBatch];
        for (int i = 0; i < kBatch; ++i) {
            const auto vertex = [&](int v) VDBTET_KERNEL {
                return Triple{mPlaces[3 * v][i], mPlaces[3 * v + 1][i], mPlaces[3 * v + 2][i]};
            };
            const TetAngles angles = tetAngles(vertex(0), vertex(1), vertex(2), vertex(3));
            mQuality[i] = tetQuality(angles);
            least[i] = angles.least;
            most[i] = angles.most;
        }
        for (int i = 0; i < kBatch; ++i) {
            mLeast = least[i] < mLeast ? least[i] : mLeast;
            mMost = mMost < most[i] ? most[i] : mMost;
        }
    });
}

} // namespace vdbtet
