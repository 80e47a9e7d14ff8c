// Step 1 of Algorithm 1: signs and cut points, by plain bisection.
#include "reference/DenseLattice.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace vdbtet::test {

namespace {

constexpr double kUncut = std::numeric_limits<double>::infinity();
constexpr int kProbes = 48;
/// A value in the middle of an edge below this part of the difference of its ends' is zero but for rounding.
constexpr double kMiddle = 1e-7;

} // namespace

DenseLattice::DenseLattice(const openvdb::CoordBBox& box, const Phi& phi, double tau) {
    for (int axis = 0; axis < 3; ++axis) {
        mOrigin[axis] = 2 * box.min()[axis];
        mCount[axis] = std::size_t(2 * (box.max()[axis] - box.min()[axis]) + 1);
    }
    const std::size_t count = mCount[0] * mCount[1] * mCount[2];
    mInside.resize(count);
    std::array<double, kDirections> uncut;
    uncut.fill(kUncut);
    mCut.resize(count, uncut);

    for (Vertex v = 0; v < count; ++v) {
        const LatticePoint p = point(v);
        const int odd = (p[0] & 1) + (p[1] & 1) + (p[2] & 1);
        if (odd != 0 && odd != 3) continue;
        (odd == 0 ? mA : mB).push_back(v);
        mInside[v] = phi(Vec3d(p) * 0.5) >= 0;
        for (int axis = 0; axis < 3 && mInside[v]; ++axis) {
            const int layer = p[axis] - mOrigin[axis];
            if (layer < 4 || layer > int(mCount[axis]) - 5)
                throw std::logic_error("the reference mesher's box is too tight");
        }
    }
    for (const Vertex a : mA)
        for (int d = 0; d < kDirections; ++d)
            if (holds(point(a) + directionVector(d))) cutEdge(a, d, phi, tau);
}

bool DenseLattice::holds(const LatticePoint& p) const {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < mOrigin[axis] || p[axis] >= mOrigin[axis] + int(mCount[axis])) return false;
    return true;
}

Vertex DenseLattice::vertex(const LatticePoint& p) const {
    const LatticePoint q = p - mOrigin;
    return (std::size_t(q[0]) * mCount[1] + std::size_t(q[1])) * mCount[2] + std::size_t(q[2]);
}

LatticePoint DenseLattice::point(Vertex v) const {
    const std::size_t z = v % mCount[2], y = v / mCount[2] % mCount[1], x = v / mCount[2] / mCount[1];
    return mOrigin + LatticePoint(int(x), int(y), int(z));
}

Vertex DenseLattice::neighbour(Vertex v, int direction) const {
    return vertex(point(v) + directionVector(direction));
}

void DenseLattice::cutEdge(Vertex a, int direction, const Phi& phi, double tau) {
    const Vertex b = neighbour(a, direction);
    if (mInside[a] == mInside[b]) return;
    const Vec3d from = Vec3d(point(a)) * 0.5, along = Vec3d(directionVector(direction)) * 0.5;
    const auto at = [&](double t) { return phi(from + t * along); };
    const auto insideAt = [&](double t) { return at(t) >= 0; };

    const double middle = std::abs(at(0.5)) / std::abs(at(1) - at(0));
    nearHalfTies += middle > 0.5 * kMiddle && middle < 2 * kMiddle;
    halfTies += middle <= kMiddle;
    double lo = 0, hi = 1;
    for (int i = 0; i < 60; ++i) {
        const double mid = 0.5 * (lo + hi);
        (insideAt(mid) == mInside[a] ? lo : hi) = mid;
    }
    const double t = middle <= kMiddle ? 0.5 : 0.5 * (lo + hi);
    mCut[a][direction] = t;
    mCut[b][opposite(direction)] = 1 - t;

    // Ties at another threshold are nobody's: a fixture shall have none.
    const double there = std::abs(at(mInside[a] ? tau : 1 - tau)) / std::abs(at(1) - at(0));
    nearHalfTies += tau != 0.5 && there < 2 * kMiddle;

    int changes = 0;
    const double start = t > 0.5 && tau == 0.5 ? 0.5 : 0, length = tau == 0.5 ? 0.5 : 1;
    bool last = start == 0 ? mInside[a] : insideAt(start);
    for (int i = 1; i <= kProbes; ++i) {
        const double probe = start + length * i / kProbes;
        const bool now = probe == 1 ? mInside[b] : insideAt(probe);
        changes += now != last;
        last = now;
    }
    manyRoots += changes > 1;
}

} // namespace vdbtet::test
