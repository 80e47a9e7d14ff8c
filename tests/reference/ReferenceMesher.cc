// Algorithms 1, 4 and 5, and version 3, over a dense lattice, one vertex and one edge at a time.
#include "reference/ReferenceMesher.h"

#include "reference/Octahedron.h"
#include "support/MeshChecker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

namespace vdbtet::test {

namespace {

using Corners = std::array<Vertex, 4>;

constexpr double kAngleTie = 1e-5;
constexpr double kGoodAngle = 11.47;
constexpr double kFarMove = 0.3;

/// What Algorithm 4's policy looks at, over some tets of a slice.
struct Score {
    double min = 180;
    double max = 0;
    bool inverted = false;
};

/// What version 3 looks at.
double worthOf(const Score& score) {
    return score.inverted ? 0 : std::min(score.min, 0.54 * (180 - score.max));
}

class Mesher {
public:
    Mesher(const DenseLattice& lattice, const Labels& labels, int tiger)
        : mLattice(lattice), mLabels(labels), mTiger(tiger) {}

    ReferenceMesh run();

    /// Version 3: destinations along the gradient.
    void moveAlongGradient(const Phi& phi, const std::vector<bool>& flagged);
    /// Flag what the guard would.
    /// @return whether anything is flagged that was not
    bool flagBad(std::vector<bool>& flagged);

private:
    bool manifold(const LatticePoint& p) const { return mLabels.manifold(mLattice.vertex(p)); }
    bool inside(const LatticePoint& p) const { return mLattice.inside(mLattice.vertex(p)); }
    bool holds(const Octahedron& o) const {
        return std::all_of(o.v.begin(), o.v.end(), [&](const auto& p) { return mLattice.holds(p); });
    }
    double travel(const LatticePoint& p) const {
        const Vertex v = mLattice.vertex(p);
        return mLattice.cutDistance(v, mLabels.move[v]);
    }
    bool movesAlong(const LatticePoint& p, const LatticePoint& direction) const {
        return mLabels.move[mLattice.vertex(p)] == directionNumber(direction);
    }

    Vec3d position(Vertex v) const;
    bool isAmbiguous(const Corners& tet) const;
    bool isInterior(const Corners& tet) const;
    std::array<Corners, 4> cornersOf(const Octahedron& o, const Slice& slice) const;
    Score score(const std::array<Corners, 4>& tets, const std::function<bool(const Corners&)>& counts) const;
    bool isBetter(const Score& a, const Score& b);

    void flip(const Octahedron& o, const Slice& slice);
    void flipActive(const Octahedron& o);
    std::optional<Slice> extraSlice(const Octahedron& o) const;
    void flipExtra(const LatticePoint& v1, const LatticePoint& e1, const LatticePoint& across);
    bool flipLastResort(const Octahedron& o, const LatticePoint& fourth);
    void visitLongEdges();
    double worth(const std::array<Corners, 4>& tets) const;
    void flipForQuality();
    std::vector<Corners> triangulation() const;

    const DenseLattice& mLattice;
    const Labels& mLabels;
    const int mTiger;
    /// The new tets of each flipped spine, by its ends in ascending order.
    std::map<std::pair<Vertex, Vertex>, std::array<Corners, 4>> mFlipped;
    std::map<Vertex, Vec3d> mOffsets; ///< of version 3
    ReferenceMesh mResult;
};

/// The axes of a spine along one of them, as for +x, turned cyclically.
std::pair<LatticePoint, LatticePoint> spineAxes(int axis) {
    LatticePoint along(0), across(0);
    along[axis] = 1;
    across[(axis + 1) % 3] = 1;
    return {along, across};
}

Vec3d Mesher::position(Vertex v) const {
    const Vec3d home = Vec3d(mLattice.point(v)) * 0.5;
    if (!mLabels.manifold(v)) return home;
    if (mTiger == 3) return home + mOffsets.at(v);
    const int d = mLabels.move[v];
    return home + mLattice.cutDistance(v, d) * 0.5 * Vec3d(directionVector(d));
}

bool Mesher::isAmbiguous(const Corners& tet) const {
    return std::all_of(tet.begin(), tet.end(), [&](Vertex v) { return mLabels.manifold(v); });
}

/// Step 8 of Algorithm 1.
bool Mesher::isInterior(const Corners& tet) const {
    return !isAmbiguous(tet) && std::all_of(tet.begin(), tet.end(), [&](Vertex v) {
        return mLabels.manifold(v) || mLattice.inside(v);
    });
}

std::array<Corners, 4> Mesher::cornersOf(const Octahedron& o, const Slice& slice) const {
    std::array<Corners, 4> result;
    for (int t = 0; t < 4; ++t)
        for (int i = 0; i < 4; ++i) result[t][i] = mLattice.vertex(o.v[slice[t][i] - 1]);
    return result;
}

Score Mesher::score(const std::array<Corners, 4>& tets,
                    const std::function<bool(const Corners&)>& counts) const {
    Score result;
    for (const Corners& tet : tets) {
        if (!counts(tet)) continue;
        const Vec3d a = position(tet[0]), b = position(tet[1]), c = position(tet[2]), d = position(tet[3]);
        result.inverted |= (b - a).cross(c - a).dot(d - a) <= 0;
        for (const double angle : angleOfEdges(a, b, c, d)) {
            result.min = std::min(result.min, angle);
            result.max = std::max(result.max, angle);
        }
    }
    return result;
}

/// The slice choice policy of Algorithm 4; of two alike neither is better.
bool Mesher::isBetter(const Score& a, const Score& b) {
    if (a.inverted != b.inverted) return b.inverted;
    const double smallerMax = b.max - a.max, largerMin = a.min - b.min;
    const bool bothGood = a.min > kGoodAngle && b.min > kGoodAngle;
    const double first = bothGood ? smallerMax : largerMin;
    const double second = bothGood ? largerMin : smallerMax;
    if (std::abs(first) > kAngleTie) return first > 0;
    mResult.sliceTies += std::abs(second) <= kAngleTie;
    return second > kAngleTie;
}

void Mesher::flip(const Octahedron& o, const Slice& slice) {
    const Vertex a = mLattice.vertex(o.v[0]), b = mLattice.vertex(o.v[1]);
    if (!mFlipped.emplace(std::minmax(a, b), cornersOf(o, slice)).second)
        throw std::logic_error("a long edge was flipped twice");
}

/// Algorithm 4.
void Mesher::flipActive(const Octahedron& o) {
    for (int i = 2; i < 6; ++i)
        if (!manifold(o.v[i])) throw std::logic_error("proposition 4 does not hold");
    const auto interior = [&](const Corners& tet) { return isInterior(tet); };
    const Score a = score(cornersOf(o, kSliceA), interior), b = score(cornersOf(o, kSliceB), interior);
    const bool slicesB = mTiger == 3 ? worthOf(b) > worthOf(a) + kAngleTie : isBetter(b, a);
    flip(o, slicesB ? kSliceB : kSliceA);
    ++mResult.activeFlips;
}

/// The slice for an octahedron whose v2, v3 and v4 move far, and as figure 10 shows.
std::optional<Slice> Mesher::extraSlice(const Octahedron& o) const {
    const LatticePoint &v2 = o.v[1], &v3 = o.v[2], &v4 = o.v[3];
    if (!manifold(v2) || !manifold(v3) || !manifold(v4)) return {};
    if (travel(v2) < kFarMove || travel(v3) < kFarMove || travel(v4) < kFarMove) return {};
    if (!movesAlong(v3, o.e1 - o.e2 - o.e3) || !movesAlong(v4, o.e1 - o.e2 + o.e3)) return {};
    if (movesAlong(v2, o.e1 + o.e2 - o.e3)) return kSliceA;
    if (movesAlong(v2, o.e1 + o.e2 + o.e3)) return kSliceB;
    return {};
}

/// Algorithm 5 for a spine from v1, which is not manifold, to v2, which is.
void Mesher::flipExtra(const LatticePoint& v1, const LatticePoint& e1, const LatticePoint& across) {
    if (!inside(v1)) return; // the octahedron is no part of the mesh
    bool conflict = false;
    const LatticePoint other = e1.cross(across);
    for (const LatticePoint& e2 : {across, other, -across, -other}) {
        const Octahedron o(v1, e1, e2);
        const std::optional<Slice> slice = extraSlice(o);
        if (!slice) continue;
        const LatticePoint &v5 = o.v[4], &v6 = o.v[5];
        if (!manifold(v5) && !manifold(v6)) {
            flip(o, *slice);
            ++mResult.extraFlips;
            return;
        }
        conflict = true;
        if (manifold(v5) && manifold(v6)) continue;
        if (flipLastResort(o, manifold(v5) ? v5 : v6)) break;
    }
    mResult.conflicts += conflict;
}

/// Section 6.2.2.
bool Mesher::flipLastResort(const Octahedron& o, const LatticePoint& fourth) {
    if (travel(fourth) >= kFarMove) return false;
    const auto interior = [&](const Corners& tet) { return isInterior(tet); };
    const Slice* best = &kSliceS;
    Score bestScore = score(cornersOf(o, kSliceS), interior);
    for (const Slice* slice : {&kSliceA, &kSliceB}) {
        const Score candidate = score(cornersOf(o, *slice), interior);
        if (!isBetter(candidate, bestScore)) continue;
        best = slice;
        bestScore = candidate;
    }
    if (best == &kSliceS) return false;
    flip(o, *best);
    ++mResult.lastResortFlips;
    return true;
}

void Mesher::visitLongEdges() {
    const auto visit = [&](Vertex lower) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto [e1, e2] = spineAxes(axis);
            const Octahedron o(mLattice.point(lower), e1, e2);
            if (!holds(o)) continue;
            const bool first = manifold(o.v[0]), second = manifold(o.v[1]);
            if (!first && !second && inside(o.v[0]) != inside(o.v[1])) flipActive(o);
            if (mTiger == 2 && !first && second) flipExtra(o.v[0], e1, e2);
            if (mTiger == 2 && first && !second) flipExtra(o.v[1], -e1, e2);
        }
    };
    for (const Vertex v : mLattice.verticesA()) visit(v);
    for (const Vertex v : mLattice.verticesB()) visit(v);
}

/// Every tet of the lattice once, by its L_A spine, but those of flipped octahedra; then the new ones.
std::vector<Corners> Mesher::triangulation() const {
    std::vector<Corners> result;
    const auto flipped = [&](const LatticePoint& a, const LatticePoint& b) {
        return mFlipped.count(std::minmax(mLattice.vertex(a), mLattice.vertex(b))) > 0;
    };
    for (const Vertex v : mLattice.verticesA()) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto [e1, e2] = spineAxes(axis);
            const Octahedron o(mLattice.point(v), e1, e2);
            if (!holds(o)) continue;
            const bool spineFlipped = flipped(o.v[0], o.v[1]);
            const std::array<Corners, 4> tets = cornersOf(o, kSliceS);
            for (int t = 0; t < 4; ++t) {
                const bool ringFlipped = flipped(o.v[kSliceS[t][1] - 1], o.v[kSliceS[t][3] - 1]);
                if (spineFlipped && ringFlipped) throw std::logic_error("two flips interfere");
                if (!spineFlipped && !ringFlipped) result.push_back(tets[t]);
            }
        }
    }
    for (const auto& [spine, tets] : mFlipped) result.insert(result.end(), tets.begin(), tets.end());
    return result;
}

void Mesher::moveAlongGradient(const Phi& phi, const std::vector<bool>& flagged) {
    const auto move = [&](Vertex v) {
        const Vec3d home = Vec3d(mLattice.point(v)) * 0.5;
        const double distance = mLattice.cutDistance(v, mLabels.move[v]);
        Vec3d offset = distance * 0.5 * Vec3d(directionVector(mLabels.move[v]));
        Vec3d gradient(0.0);
        for (int d = 0; d < kDirections; ++d) {
            const Vec3d edge = 0.5 * Vec3d(directionVector(d));
            gradient += 0.5 * edge * phi(home + edge);
        }
        const Vec3d way = gradient.unit() * ((mLattice.inside(v) ? -1 : 1) * distance * std::sqrt(0.75));
        if (!flagged[v] && (phi(home + way) >= 0) != mLattice.inside(v)) {
            double lo = 0, hi = 1;
            for (int i = 0; i < 60; ++i) {
                const double mid = 0.5 * (lo + hi);
                ((phi(home + mid * way) >= 0) == mLattice.inside(v) ? lo : hi) = mid;
            }
            offset = 0.5 * (lo + hi) * way;
        }
        mOffsets[v] = offset;
    };
    for (const Vertex v : mLattice.verticesA())
        if (mLabels.manifold(v)) move(v);
    for (const Vertex v : mLattice.verticesB())
        if (mLabels.manifold(v)) move(v);
}

double Mesher::worth(const std::array<Corners, 4>& tets) const {
    return worthOf(score(tets, [](const Corners&) { return true; }));
}

/// One round: each candidate against those at its ring edges, the tets it shares.
void Mesher::flipForQuality() {
    struct Candidate {
        Octahedron octahedron;
        const Slice* slice;
        double gain;
        std::array<int, 4> order; // by place, then L_A first: of a tie the first one flips
    };
    std::map<std::pair<Vertex, Vertex>, Candidate> candidates;
    const auto allInterior = [&](const std::array<Corners, 4>& tets) {
        return std::all_of(tets.begin(), tets.end(), [&](const Corners& tet) { return isInterior(tet); });
    };
    const auto visit = [&](Vertex lower) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto [e1, e2] = spineAxes(axis);
            const Octahedron o(mLattice.point(lower), e1, e2);
            if (!holds(o)) continue;
            const auto on = std::count_if(o.v.begin(), o.v.end(), [&](const auto& p) { return manifold(p); });
            const auto standard = cornersOf(o, kSliceS);
            if (on < 2 || !allInterior(standard)) continue;
            const double now = worth(standard);
            Candidate best{o, nullptr, 0.1, {}};
            for (const Slice* slice : {&kSliceA, &kSliceB}) {
                const auto tets = cornersOf(o, *slice);
                const double gain = worth(tets) - now;
                mResult.sliceTies += best.slice != nullptr && std::abs(gain - best.gain) <= kAngleTie;
                mResult.sliceTies += std::abs(gain - 0.1) <= kAngleTie;
                if (!allInterior(tets) || gain <= best.gain + (best.slice ? kAngleTie : 0)) continue;
                best.slice = slice;
                best.gain = gain;
            }
            if (!best.slice) continue;
            const LatticePoint p = o.v[0];
            best.order = {p[0] >> 1, p[1] >> 1, p[2] >> 1, p[0] & 1};
            candidates.emplace(std::minmax(mLattice.vertex(o.v[0]), mLattice.vertex(o.v[1])), best);
        }
    };
    for (const Vertex v : mLattice.verticesA()) visit(v);
    for (const Vertex v : mLattice.verticesB()) visit(v);
    std::vector<const Candidate*> chosen;
    for (const auto& [spine, candidate] : candidates) {
        bool wins = true;
        for (int r = 0; r < 4; ++r) {
            const Vertex a = mLattice.vertex(candidate.octahedron.v[std::size_t(2 + r)]),
                         b = mLattice.vertex(candidate.octahedron.v[std::size_t(2 + (r + 1) % 4)]);
            if (mFlipped.count(std::minmax(a, b)))
                throw std::logic_error("a candidate has an active ring edge");
            const auto other = candidates.find(std::minmax(a, b));
            if (other == candidates.end()) continue;
            const double more = candidate.gain - other->second.gain;
            wins = wins && (std::abs(more) <= kAngleTie ? candidate.order < other->second.order : more > 0);
        }
        if (wins) chosen.push_back(&candidate);
    }
    for (const Candidate* candidate : chosen) flip(candidate->octahedron, *candidate->slice);
    mResult.qualityFlips += std::int64_t(chosen.size());
}

bool Mesher::flagBad(std::vector<bool>& flagged) {
    visitLongEdges();
    flipForQuality();
    bool isNew = false;
    const auto flag = [&](Vertex v) {
        if (!mLabels.manifold(v) || flagged[v]) return;
        flagged[v] = isNew = true;
    };
    const auto isBad = [&](const Corners& tet) {
        if (!isInterior(tet)) return false;
        const Score one = score({tet, tet, tet, tet}, [](const Corners&) { return true; });
        return one.inverted || one.min <= 18 || one.max >= 146;
    };
    for (const auto& [spine, tets] : mFlipped) {
        if (std::none_of(tets.begin(), tets.end(), isBad)) continue;
        for (const Corners& tet : tets)
            for (const Vertex v : tet) flag(v);
    }
    std::vector<Corners> others = triangulation();
    others.resize(others.size() - 4 * mFlipped.size());
    for (const Corners& tet : others) {
        if (!isBad(tet) && !isAmbiguous(tet)) continue;
        for (const Vertex v : tet) flag(v);
    }
    return isNew;
}

ReferenceMesh Mesher::run() {
    if (mTiger < 3) visitLongEdges();
    std::map<Vertex, std::int64_t> ids;
    for (const Corners& tet : triangulation()) {
        mResult.ambiguous += isAmbiguous(tet);
        if (!isInterior(tet)) continue;
        std::array<std::int64_t, 4> corners;
        for (int i = 0; i < 4; ++i) {
            const auto [it, isNew] = ids.emplace(tet[i], std::int64_t(mResult.points.size()));
            if (isNew) mResult.points.push_back(position(tet[i]));
            corners[i] = it->second;
        }
        mResult.tets.push_back(corners);
    }
    for (const Vertex v : mLattice.verticesA())
        for (int d = 0; d < kDirections; ++d) mResult.cutEdges += mLattice.isCut(v, d);
    mResult.manyRoots = mLattice.manyRoots;
    mResult.halfTies = mLattice.halfTies;
    mResult.nearHalfTies = mLattice.nearHalfTies;
    mResult.undecided = mLabels.undecided;
    mResult.destinationTies = mLabels.destinationTies;
    mResult.staleDestinations = mLabels.staleDestinations;
    return mResult;
}

} // namespace

ReferenceMesh referenceMesh(const Phi& phi, const openvdb::CoordBBox& box, int tiger, Labelling labelling) {
    const DenseLattice lattice(box, phi);
    const Labels labels = labelling == Labelling::Search ? searchedLabels(lattice) : kernelLabels(lattice);
    return Mesher(lattice, labels, tiger).run();
}

ReferenceMesh thirdReferenceMesh(const Phi& phi, const openvdb::CoordBBox& box, double tau) {
    const DenseLattice lattice(box, phi, tau);
    Threshold threshold{tau, std::vector<bool>(lattice.size())};
    for (std::int64_t rounds = 0;; ++rounds) {
        const Labels labels = kernelLabels(lattice, threshold);
        Mesher mesher(lattice, labels, 3);
        mesher.moveAlongGradient(phi, threshold.flagged);
        if (mesher.flagBad(threshold.flagged)) continue;
        ReferenceMesh mesh = mesher.run();
        mesh.flagged = std::count(threshold.flagged.begin(), threshold.flagged.end(), true);
        mesh.guardRounds = rounds;
        return mesh;
    }
}

} // namespace vdbtet::test
