/// @file SplitFans.cc
/// Walks about points, from triangle to triangle.
#include "io/SplitFans.h"

#include <openvdb/math/Math.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

constexpr double kTurn = 6.283185307179586;

/// An edge of a triangle, from corner @a side to the next.
struct HalfEdge {
    std::int64_t triangle;
    std::size_t side;

    friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
        return std::pair(a.triangle, a.side) < std::pair(b.triangle, b.side);
    }
};

class FanSplitter {
public:
    FanSplitter(std::vector<Vec3d>& points, std::vector<Triangle>& triangles)
        : mPoints(points), mTriangles(triangles), mFirst(points.size() + 1) {
        for (const Triangle& triangle : mTriangles) {
            for (const std::int64_t v : triangle) ++mFirst[std::size_t(v) + 1];
        }
        for (std::size_t v = 0; v < points.size(); ++v) mFirst[v + 1] += mFirst[v];
        mCorners.resize(3 * mTriangles.size());
        std::vector<std::int64_t> next(mFirst.begin(), mFirst.end() - 1);
        for (std::size_t t = 0; t < mTriangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i)
                mCorners[std::size_t(next[std::size_t(mTriangles[t][i])]++)] = {std::int64_t(t), i};
        }
    }

    std::int64_t split() {
        const auto points = std::int64_t(mPoints.size());
        for (std::int64_t v = 0; v < points; ++v) pairWedges(v);
        for (const auto& pairs : mCrowded) separate(pairs);
        // All fans first, for neighbours are told by the points as they were.
        std::vector<std::pair<HalfEdge, std::int64_t>> copies;
        for (std::int64_t v = 0; v < points; ++v) addCopies(v, copies);
        for (const auto& [corner, copy] : copies)
            mTriangles[std::size_t(corner.triangle)][corner.side] = copy;
        return std::int64_t(mPoints.size()) - points;
    }

private:
    using Pairs = std::vector<std::pair<HalfEdge, HalfEdge>>;

    std::int64_t start(const HalfEdge& e) const { return mTriangles[std::size_t(e.triangle)][e.side]; }
    std::int64_t end(const HalfEdge& e) const {
        return mTriangles[std::size_t(e.triangle)][(e.side + 1) % 3];
    }

    /// The edges of triangles that start at a point: one for each of its corners there.
    const HalfEdge* begin(std::int64_t v) const { return mCorners.data() + mFirst[std::size_t(v)]; }
    const HalfEdge* end(std::int64_t v) const { return mCorners.data() + mFirst[std::size_t(v) + 1]; }

    /// Pair the triangles at the edges from a point to higher ones that have more than two.
    void pairWedges(std::int64_t v) {
        for (const HalfEdge* e = begin(v); e != end(v); ++e) {
            const std::int64_t w = end(*e);
            const auto toW = [&](const HalfEdge& other) { return end(other) == w; };
            if (w < v || std::find_if(begin(v), e, toW) != e || std::count_if(e, end(v), toW) < 2) continue;
            Pairs pairs;
            std::vector<HalfEdge> back;
            std::copy_if(begin(w), end(w), std::back_inserter(back),
                         [&](const HalfEdge& other) { return end(other) == v; });
            for (const HalfEdge* out = e; out != end(v); ++out) {
                if (!toW(*out)) continue;
                // Behind its triangle is solid, up to the first that faces the other way.
                const double angle = angleOf(*out, v, w);
                const auto wedge = [&](const HalfEdge& other) {
                    const double turn = angle - angleOf(other, v, w);
                    return turn < 0.0 ? turn + kTurn : turn;
                };
                const auto nearest =
                    std::min_element(back.begin(), back.end(), [&](const HalfEdge& a, const HalfEdge& b) {
                        return wedge(a) < wedge(b);
                    });
                pairs.emplace_back(*out, *nearest);
                back.erase(nearest);
            }
            for (const auto& [out, in] : pairs) join(out, in);
            mCrowded.push_back(std::move(pairs));
        }
    }

    /// The direction of a triangle's third corner about an edge, counter-clockwise as seen from its end.
    double angleOf(const HalfEdge& e, std::int64_t from, std::int64_t to) const {
        const auto at = [&](std::int64_t v) { return mPoints[std::size_t(v)]; };
        Vec3d axis = at(to) - at(from);
        axis.normalize(0.0);
        // Any direction that is not the axis's, and the same for all triangles of an edge.
        Vec3d least(0.0);
        least[openvdb::math::MinIndex(
            openvdb::Vec3d(std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])))] = 1.0;
        const Vec3d x = axis.cross(least), y = axis.cross(x);
        const Vec3d apex = at(mTriangles[std::size_t(e.triangle)][(e.side + 2) % 3]) - at(from);
        return std::atan2(apex.dot(y), apex.dot(x));
    }

    void join(const HalfEdge& a, const HalfEdge& b) {
        mPartners[a] = b;
        mPartners[b] = a;
    }

    /// The corner beyond the edge that ends at a corner's point.
    HalfEdge next(const HalfEdge& corner) const {
        const HalfEdge in{corner.triangle, (corner.side + 2) % 3};
        const auto partner = mPartners.find(in);
        if (partner != mPartners.end()) return partner->second;
        const std::int64_t v = start(corner), from = start(in);
        return *std::find_if(begin(v), end(v), [&](const HalfEdge& e) { return end(e) == from; });
    }

    bool inOneFan(const HalfEdge& a, const HalfEdge& b) const {
        HalfEdge corner = a;
        do {
            if (corner.triangle == b.triangle) return true;
            corner = next(corner);
        } while (corner.triangle != a.triangle);
        return false;
    }

    /// Swap neighbours until no two pairs at an edge are in one fan at both of its ends. A swap splits that
    /// fan at each end, so pairs that are apart stay so.
    void separate(Pairs pairs) {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            for (std::size_t j = i + 1; j < pairs.size(); ++j) {
                const auto [out, in] = pairs[i];
                const auto [otherOut, otherIn] = pairs[j];
                if (!inOneFan(out, otherOut) || !inOneFan(in, otherIn)) continue;
                std::swap(pairs[i].second, pairs[j].second);
                join(pairs[i].first, pairs[i].second);
                join(pairs[j].first, pairs[j].second);
            }
        }
    }

    /// Note the corners that get other points, and add these.
    void addCopies(std::int64_t v, std::vector<std::pair<HalfEdge, std::int64_t>>& copies) {
        const auto count = std::size_t(end(v) - begin(v));
        std::vector<std::int64_t> done; // triangles
        done.reserve(count);
        while (done.size() < count) {
            const HalfEdge first = *std::find_if(begin(v), end(v), [&](const HalfEdge& e) {
                return std::find(done.begin(), done.end(), e.triangle) == done.end();
            });
            const bool isCopy = !done.empty();
            if (isCopy) mPoints.push_back(Vec3d(mPoints[std::size_t(v)]));
            HalfEdge corner = first;
            do {
                done.push_back(corner.triangle);
                if (isCopy) copies.emplace_back(corner, std::int64_t(mPoints.size()) - 1);
                corner = next(corner);
            } while (corner.triangle != first.triangle);
        }
    }

    std::vector<Vec3d>& mPoints;
    std::vector<Triangle>& mTriangles;
    std::vector<std::int64_t> mFirst; ///< of each point: of its corners in mCorners
    std::vector<HalfEdge> mCorners;
    std::vector<Pairs> mCrowded;            ///< of each edge of more than two triangles
    std::map<HalfEdge, HalfEdge> mPartners; ///< there: the triangle beyond an edge
};

} // namespace

std::int64_t splitFans(std::vector<Vec3d>& points, std::vector<Triangle>& triangles) {
    return FanSplitter(points, triangles).split();
}

} // namespace vdbtet
