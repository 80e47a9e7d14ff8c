/// @file CutDistances.cc
/// distanceToCut() in lanes: each goes through the steps of rootInUnitInterval() and stops by itself.
#include "field/CutDistances.h"

#include "field/Root.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbtet {

namespace {

constexpr int kLanes = CutEdges::kLanes;

/// The diagonals of all lanes.
struct Lanes {
    double b0[kLanes], b1[kLanes], b2[kLanes], b3[kLanes];
    double start = 0.0, slope[kLanes]; ///< the diagonal's parameter is start + slope * (fraction of the
                                       ///< near part)

    VDBTET_KERNEL inline explicit Lanes(const CutEdges& edges) {
        for (int i = 0; i < kLanes; ++i) {
            const auto& p = edges.corners;
            const double corners[8] = {p[0][i], p[1][i], p[2][i], p[3][i],
                                       p[4][i], p[5][i], p[6][i], p[7][i]};
            const Diagonal phi = Diagonal::of(corners);
            b0[i] = phi.b0;
            b1[i] = phi.b1;
            b2[i] = phi.b2;
            b3[i] = phi.b3;
        }
    }
    VDBTET_KERNEL inline Diagonal diagonal(int i) const { return {b0[i], b1[i], b2[i], b3[i]}; }
    VDBTET_KERNEL inline double evaluate(int i, double x) const { return diagonal(i)(start + slope[i] * x); }
};

/// What rootInUnitInterval() knows of each edge, the interval being the part at the near end. Short loops
/// over all lanes: a processor looks ahead over a few of their rounds only.
class Brackets {
public:
    /// @param near   the field at the near end
    /// @param count  lanes beyond it are left alone
    VDBTET_KERNEL inline Brackets(const Lanes& lanes, const double (&near)[kLanes], int count) {
        for (int i = 0; i < kLanes; ++i) {
            // Of two signs that differ the near end's shall be the positive one.
            const double side = near[i] >= 0.0 ? 1.0 : -1.0;
            mSide[i] = side;
            mFa[i] = side * near[i];
            mFb[i] = side * lanes.evaluate(i, 1.0);
        }
        for (int i = 0; i < kLanes; ++i) {
            // By the rule for ties the cut point may lie just beyond.
            const double root = mFb[i] >= 0.0 ? 1.0 : 0.0;
            mActive[i] = (mFb[i] < 0.0) & (mFa[i] != 0.0) & (i < count) ? 1 : 0;
            mX[i] = mActive[i] != 0 ? 2.0 : root;
            mA[i] = 0.0;
            mB[i] = 1.0;
            mWeightA[i] = 1.0;
            mWeightB[i] = 1.0;
        }
    }

    VDBTET_KERNEL inline void solve(const Lanes& lanes, double (&root)[kLanes]) {
        for (int iteration = 0; iteration < kRootIterations; ++iteration) {
            step();
            std::int64_t left = 0;
            for (int i = 0; i < kLanes; ++i) left += mActive[i];
            if (left == 0) break;
            narrow(lanes);
        }
        for (int i = 0; i < kLanes; ++i) root[i] = mActive[i] != 0 ? 0.5 * (mA[i] + mB[i]) : mX[i];
    }

private:
    /// Go to the next guess; stop where that is near the last one, whatever the field is there.
    VDBTET_KERNEL inline void step() {
        for (int i = 0; i < kLanes; ++i) {
            const double a = mA[i], b = mB[i], fa = mFa[i], fb = mFb[i];
            const double secant = (a * fb - b * fa) / (fb - fa);
            const double middle = 0.5 * (a + b);
            const double x = ((secant > a) & (secant < b)) ? secant : middle;
            const bool found = (std::abs(x - mX[i]) < kRootTolerance) | (b - a < kRootTolerance);
            mX[i] = mActive[i] != 0 ? x : mX[i];
            mActive[i] = found ? 0 : mActive[i];
        }
    }
    /// Replace an end of the bracket by the guess.
    VDBTET_KERNEL inline void narrow(const Lanes& lanes) {
        for (int i = 0; i < kLanes; ++i) {
            const double x = mX[i], a = mA[i], b = mB[i];
            const double fx = mSide[i] * lanes.evaluate(i, x);
            mActive[i] = fx == 0.0 ? 0 : mActive[i];
            // An end that stays twice has its weight halved.
            const bool moveA = fx > 0.0;
            const double lighterA = mWeightA[i] * mFa[i], lighterB = mWeightB[i] * mFb[i];
            mFa[i] = moveA ? fx : lighterA;
            mFb[i] = moveA ? lighterB : fx;
            mWeightA[i] = moveA ? 1.0 : 0.5;
            mWeightB[i] = moveA ? 0.5 : 1.0;
            // Selects from a and b would become conditional stores.
            const double low = moveA ? x : 0.0, high = moveA ? 1.0 : x;
            mA[i] = low > a ? low : a;
            mB[i] = high < b ? high : b;
        }
    }

    double mA[kLanes], mB[kLanes], mFa[kLanes], mFb[kLanes];
    double mWeightA[kLanes], mWeightB[kLanes]; ///< of the field at an end that stays
    double mSide[kLanes];                      ///< the sign of the field at the near end
    double mX[kLanes];                         ///< the last guess, in the end the root
    std::int64_t mActive[kLanes];              ///< 0 or 1, as wide as a double
};

} // namespace

std::uint32_t cutsInFirstPart(const CutEdges& edges, Isa isa) {
    std::uint32_t result = 0;
    runOn(isa, [&]() VDBTET_KERNEL {
        const Lanes lanes(edges);
        std::int64_t first[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            const Diagonal phi = lanes.diagonal(i);
            const double near = phi.b0, far = phi(1.0);
            const double middle = phi(near >= 0.0 ? edges.tau[i] : 1.0 - edges.tau[i]);
            const std::int64_t tie = std::abs(middle) <= kMiddle * std::abs(far - near) ? 1 : 0,
                               nearInside = near >= 0.0 ? 1 : 0, middleInside = middle >= 0.0 ? 1 : 0;
            first[i] = tie | (nearInside ^ middleInside);
        }
        for (int i = 0; i < kLanes; ++i) result |= std::uint32_t(first[i]) << i;
    });
    return edges.full() ? result : result & ((std::uint32_t(1) << edges.count) - 1);
}

void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa) {
    runOn(isa, [&]() VDBTET_KERNEL {
        Lanes lanes(edges);
        lanes.start = nearIsB ? 1.0 : 0.0;
        double reach[kLanes], root[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            reach[i] = edges.near[i] >= 0.0 ? edges.tau[i] : 1.0 - edges.tau[i];
            lanes.slope[i] = nearIsB ? -reach[i] : reach[i];
        }
        Brackets(lanes, edges.near, edges.count).solve(lanes, root);
        for (int i = 0; i < edges.count; ++i) distance[i] = float(reach[i] * root[i]);
    });
}

} // namespace vdbtet
