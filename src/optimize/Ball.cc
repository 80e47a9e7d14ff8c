/// @file Ball.cc
/// Lanes of tets that share a vertex.
#include "optimize/Ball.h"

#include <algorithm>
#include <utility>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

/// How far the vertex is moved to see how a quality changes, lattice units.
constexpr double kDifference = 1e-4;

} // namespace

/// The angles of kLanes tets.
struct Ball::Block {
    double least[kLanes], most[kLanes], volume6[kLanes];

    VDBTET_KERNEL inline Block(const Ball& ball, int first, const Triple& at) {
        const auto& f = ball.mPlaces;
        for (int lane = 0; lane < kLanes; ++lane) {
            const int i = first + lane;
            const TetAngles angles = tetAngles(at, {f[0][i], f[1][i], f[2][i]}, {f[3][i], f[4][i], f[5][i]},
                                               {f[6][i], f[7][i], f[8][i]});
            least[lane] = angles.least;
            most[lane] = angles.most;
            volume6[lane] = angles.volume6;
        }
    }

    /// Of all lanes.
    VDBTET_KERNEL inline TetAngles worst() const {
        TetAngles worst{least[0], most[0], volume6[0]};
        for (int i = 1; i < kLanes; ++i) {
            worst.least = least[i] < worst.least ? least[i] : worst.least;
            worst.most = worst.most < most[i] ? most[i] : worst.most;
            worst.volume6 = volume6[i] < worst.volume6 ? volume6[i] : worst.volume6;
        }
        return worst;
    }
};

void Ball::complete() {
    static_assert(kMost % kLanes == 0, "blocks are whole");
    for (int i = mCount; i % kLanes != 0; ++i) {
        for (auto& row : mPlaces) row[i] = row[0];
    }
}

BallQuality Ball::judge(const Vec3d& at) {
    const Triple v{at.x(), at.y(), at.z()};
    BallQuality all;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int first = 0; first < mCount; first += kLanes) {
            const Block block(*this, first, v);
            for (int i = 0; i < kLanes; ++i)
                mQuality[first + i] = tetQuality({block.least[i], block.most[i], block.volume6[i]});
            const TetAngles worst = block.worst();
            all.acute = std::min(all.acute, acuteSine2(worst.most));
            all.obtuse = std::min(all.obtuse, obtuseSine2(worst.least));
            all.inverted = all.inverted || !(worst.volume6 > kLeastVolume6);
        }
    });
    return all;
}

void Ball::sort(int front) {
    for (int i = 0; i < std::min(front, mCount); ++i) {
        const auto worst = int(std::min_element(mQuality + i, mQuality + mCount) - mQuality);
        if (worst == i) continue;
        for (auto& row : mPlaces) std::swap(row[i], row[worst]);
        std::swap(mFaces[i], mFaces[worst]);
        std::swap(mQuality[i], mQuality[worst]);
    }
}

void Ball::gradients(const Vec3d& at, int count, Vec3d* gradients) const {
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int axis = 0; axis < 3; ++axis) {
            const double step[3] = {axis == 0 ? kDifference : 0.0, axis == 1 ? kDifference : 0.0,
                                    axis == 2 ? kDifference : 0.0};
            const Block block(*this, 0, {at.x() + step[0], at.y() + step[1], at.z() + step[2]});
            for (int i = 0; i < count; ++i) {
                const double moved = tetQuality({block.least[i], block.most[i], block.volume6[i]});
                gradients[i][axis] = (moved - mQuality[i]) / kDifference;
            }
        }
    });
}

bool Ball::passes(const Vec3d& at, const BallLimits& limits) const {
    const Triple v{at.x(), at.y(), at.z()};
    bool passed = true;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        // The worst tets come first, and few candidates get past them.
        for (int first = 0; first < mCount && passed; first += kLanes) {
            const TetAngles worst = Block(*this, first, v).worst();
            const double acute = acuteSine2(worst.most), obtuse = obtuseSine2(worst.least);
            passed = (worst.volume6 > kLeastVolume6) & (acute > limits.quality) &
                     (kObtuseWeight * obtuse > limits.quality) & (acute >= limits.acute) &
                     (obtuse >= limits.obtuse);
        }
    });
    return passed;
}

} // namespace vdbtet
