// Matches points by a hash of their cells, then compares the sorted tets.
#include "support/MeshMatch.h"

#include "support/Catch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>
#include <unordered_map>

namespace vdbtet::test {

using openvdb::Vec3d;

namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        return std::size_t(c[0]) * 73856093u ^ std::size_t(c[1]) * 19349663u ^ std::size_t(c[2]) * 83492791u;
    }
};

/// Finds the point of a set that is nearest to a given one, within a tolerance.
class PointFinder {
public:
    PointFinder(const std::vector<Vec3d>& points, const Vec3d& origin, double tolerance)
        : mPoints(points), mOrigin(origin), mTolerance(tolerance) {
        for (std::size_t i = 0; i < points.size(); ++i) mCells.emplace(cell(points[i]), i);
    }

    /// @return the point's index, or -1.
    std::int64_t find(const Vec3d& p) const {
        std::int64_t nearest = -1;
        double distance = mTolerance;
        for (int corner = 0; corner < 8; ++corner) {
            // Cells are four tolerances wide, so that the eight corners of p's ball reach all of them.
            const Vec3d reach(corner & 1 ? mTolerance : -mTolerance, corner & 2 ? mTolerance : -mTolerance,
                              corner & 4 ? mTolerance : -mTolerance);
            const auto [first, last] = mCells.equal_range(cell(p + reach));
            for (auto it = first; it != last; ++it) {
                const double d = (mPoints[it->second] - p).length();
                if (d > distance) continue;
                distance = d;
                nearest = std::int64_t(it->second);
            }
        }
        return nearest;
    }

private:
    Cell cell(const Vec3d& p) const {
        const Vec3d q = (p - mOrigin) / (4 * mTolerance);
        return {std::int64_t(std::floor(q[0])), std::int64_t(std::floor(q[1])),
                std::int64_t(std::floor(q[2]))};
    }

    const std::vector<Vec3d>& mPoints;
    Vec3d mOrigin;
    double mTolerance;
    std::unordered_multimap<Cell, std::size_t, CellHash> mCells;
};

std::vector<Tet> sortedTets(const std::vector<Tet>& tets, const std::vector<std::int64_t>* renumber) {
    std::vector<Tet> result = tets;
    for (Tet& tet : result) {
        if (renumber)
            for (std::int64_t& id : tet) id = (*renumber)[std::size_t(id)];
        std::sort(tet.begin(), tet.end());
    }
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace

MeshMatch matchMeshes(const TetMesh& a, const TetMesh& b, double tolerance) {
    MeshMatch match;
    std::ostringstream difference;
    difference.precision(17);
    const auto differs = [&] {
        match.difference = difference.str();
        return match;
    };
    if (a.points.size() != b.points.size() || a.tets.size() != b.tets.size())
        difference << a.points.size() << " points and " << a.tets.size() << " tets, but " << b.points.size()
                   << " and " << b.tets.size() << "; ";

    const PointFinder finder(b.points, b.points.empty() ? Vec3d(0.0) : b.points.front(), tolerance);
    std::vector<std::int64_t> toB;
    std::vector<bool> taken(b.points.size());
    for (const Vec3d& p : a.points) {
        const std::int64_t id = finder.find(p);
        if (id < 0) {
            difference << "a point of the first alone: " << p;
            return differs();
        }
        if (taken[std::size_t(id)]) {
            difference << "two points of the first for one: " << p;
            return differs();
        }
        taken[std::size_t(id)] = true;
        match.farthest = std::max(match.farthest, (b.points[std::size_t(id)] - p).length());
        toB.push_back(id);
    }
    const std::vector<Tet> ours = sortedTets(a.tets, &toB), theirs = sortedTets(b.tets, nullptr);
    std::vector<Tet> alone;
    std::set_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(alone));
    if (!alone.empty()) {
        difference << alone.size() << " tets of the first alone, one at";
        for (const std::int64_t id : alone.front()) difference << ' ' << b.points[std::size_t(id)];
        return differs();
    }
    match.same = a.points.size() == b.points.size() && ours.size() == theirs.size();
    return match.same ? match : differs();
}

void requireSame(const TetMesh& a, const TetMesh& b, double tolerance) {
    const MeshMatch match = matchMeshes(a, b, tolerance);
    INFO(match.difference);
    REQUIRE(match.same);
}

void requireIdentical(const TetMesh& a, const TetMesh& b) {
    REQUIRE(a.points.size() == b.points.size());
    REQUIRE(a.tets.size() == b.tets.size());
    REQUIRE(!a.tets.empty());
    CHECK(std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3d)) == 0);
    CHECK(std::memcmp(a.tets.data(), b.tets.data(), a.tets.size() * sizeof(Tet)) == 0);
}

} // namespace vdbtet::test
