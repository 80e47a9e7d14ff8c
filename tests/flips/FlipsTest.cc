/// Algorithms 4 and 5 on constructed labels: every spine, both ends, all mirror images, and the bounds of the
/// paper's appendix.
#include "support/Catch.h"

#include "flips/Flips.h"
#include "flips/Slices.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>

namespace vdbtet::test {

using openvdb::Vec3d;

namespace {

/// One octahedron in the middle of a lonely tile; its vertices are inside and still until told otherwise.
class Constructed {
public:
    Constructed(bcc::Lattice lattice, int axis) : mSigns(1) {
        mLayout.surfaceTiles = {openvdb::Coord(0)};
        mLayout.spans.append({openvdb::Coord(0), 1, 0});
        mLayout.neighbours.resize(1);
        mLayout.neighbours[0].fill(kOutside);
        mLayout.neighbours[0][neighbourSlot(0, 0, 0)] = 0;
        mSigns[0].fill(TileMask::filled(true));
        mOctahedron = localOctahedron(lattice, axis, localIndex(lattice, 3, 3, 3));
    }

    void setOutside(int number) { mSigns[0][lattice(number)].reset(bit(number)); }

    /// Make a vertex manifold, moving in @a direction by the fraction @a alpha of a short edge.
    void setMove(int number, int direction, double alpha) { mMoves[number] = {direction, alpha}; }

    Vec3d home(int number) const { return homeOf(mOctahedron[number]); }

    /// The direction of the short edge from vertex @a from to @a to, or parallel to it.
    int direction(int from, int to) const {
        const Vec3d edge = home(to) - home(from);
        return 4 * (edge.x() > 0.0) + 2 * (edge.y() > 0.0) + (edge.z() > 0.0);
    }

    const LocalOctahedron& octahedron() const { return mOctahedron; }

    const LocalVertices& load() {
        mLabels.manifold.assign(1, {});
        std::vector<int> order;
        for (int number = 0; number < 6; ++number) {
            if (mMoves[number].direction < 0) continue;
            mLabels.manifold[0][lattice(number)].set(bit(number));
            order.push_back(number);
        }
        std::sort(order.begin(), order.end(), [&](int a, int b) { return mOctahedron[a] < mOctahedron[b]; });
        const auto moves = std::size_t(mDestinations.number(mLabels.manifold));
        mDestinations.directions.resize(moves);
        mDestinations.distances.resize(moves);
        for (std::size_t i = 0; i < order.size(); ++i) {
            mDestinations.directions[i] = std::uint8_t(mMoves[order[i]].direction);
            mDestinations.distances[i] = float(mMoves[order[i]].alpha);
        }
        mLocal.load(0);
        return mLocal;
    }

private:
    int lattice(int number) const { return latticeOf(mOctahedron[number]); }
    int bit(int number) const {
        const int n = bitOf(mOctahedron[number]);
        return TileMask::bit(PaddedMask::x(n), PaddedMask::y(n), PaddedMask::z(n));
    }

    struct Move {
        int direction = -1;
        double alpha = 0.0;
    };

    Layout mLayout;
    std::vector<TileSigns> mSigns;
    Labels mLabels;
    Destinations mDestinations;
    LocalOctahedron mOctahedron;
    std::array<Move, 6> mMoves;
    Vertices mVertices{mLayout, mSigns, mLabels, mDestinations};
    LocalVertices mLocal{mVertices};
};

struct Angles {
    double min = 180.0, max = 0.0;
    bool inverted = false;

    void add(const LocalVertices& local, const LocalOctahedron& o, const int (&tet)[4]) {
        const Vec3d a = local.position(o[tet[0]]), b = local.position(o[tet[1]]),
                    c = local.position(o[tet[2]]), d = local.position(o[tet[3]]);
        inverted = inverted || signedVolume6(a, b, c, d) <= 0.0;
        for (double angle : dihedralAngles(a, b, c, d)) {
            min = std::min(min, angle);
            max = std::max(max, angle);
        }
    }
    void add(const LocalVertices& local, const LocalOctahedron& o, bcc::Slice slice) {
        for (const auto& tet : bcc::kSliceTets[slice]) add(local, o, tet);
    }
};

/// One of Algorithm 5's configurations.
struct Figure {
    bcc::Lattice lattice;
    int axis;
    bool reversed; ///< v2 is the spine's lower end
    int pair;      ///< the ring's number of v3
    int figureCase;

    int v1() const { return reversed ? 1 : 0; }
    int v2() const { return reversed ? 0 : 1; }
    int ring(int i) const { return 2 + (pair + i) % 4; }
    int v3() const { return ring(0); }
    int v4() const { return ring(1); }
    int v5() const { return ring(2); }
    int v6() const { return ring(3); }

    Constructed construct(double a2, double a3, double a4) const {
        Constructed c(lattice, axis);
        c.setMove(v3(), c.direction(v4(), v2()), a3);
        c.setMove(v4(), c.direction(v3(), v2()), a4);
        c.setMove(v2(), c.direction(figureCase == 1 ? v5() : v6(), v2()), a2);
        return c;
    }

    /// The slice whose new edge ends where v2 moves away from.
    bcc::Slice best() const {
        return ((pair + (figureCase == 1 ? 2 : 3)) % 2 == 0) ? bcc::SliceA : bcc::SliceB;
    }
};

bcc::Slice chooseActiveSlice(const LocalVertices& local, const LocalOctahedron& octahedron) {
    std::vector<bcc::Slice> slices;
    chooseActiveSlices(local, {octahedron}, SliceRule::Policy, slices);
    REQUIRE(slices.size() == 1);
    return slices[0];
}

template <typename Visit>
void forEachFigure(Visit&& visit) {
    for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (bool reversed : {false, true}) {
                for (int pair = 0; pair < 4; ++pair) {
                    for (int figureCase : {1, 2}) visit(Figure{lattice, axis, reversed, pair, figureCase});
                }
            }
        }
    }
}

} // namespace

TEST_CASE("Algorithm 5 flips to the better slice at every spine, end and mirror image", "[flips]") {
    forEachFigure([](const Figure& figure) {
        Angles best, other;
        for (double a2 : {0.3001, 0.4, 0.5}) {
            for (double a3 : {0.3001, 0.4, 0.5}) {
                for (double a4 : {0.3001, 0.4, 0.5}) {
                    Constructed c = figure.construct(a2, a3, a4);
                    const LocalVertices& local = c.load();
                    const ExtraFlip flip = chooseExtraSlice(local, c.octahedron());
                    REQUIRE(flip.matches);
                    REQUIRE(!flip.conflict);
                    REQUIRE(flip.slice == figure.best());
                    best.add(local, c.octahedron(), flip.slice);
                    other.add(local, c.octahedron(), flip.slice == bcc::SliceA ? bcc::SliceB : bcc::SliceA);
                }
            }
        }
        REQUIRE(!best.inverted);
        REQUIRE(best.min > 25.35);
        REQUIRE(best.max < 143.93);
        // Equation (28), either slice, and nearly attained by the worse one.
        REQUIRE(other.min > 18.53);
        REQUIRE(other.max < 150.01);
        REQUIRE(other.min < 19.0);
    });
}

TEST_CASE("without Algorithm 5 the same octahedra hold the worst tets of all", "[flips]") {
    forEachFigure([](const Figure& figure) {
        Constructed c = figure.construct(0.5, 0.5, 0.5);
        Angles spine;
        spine.add(c.load(), c.octahedron(), bcc::S);
        REQUIRE(spine.min == Approx(8.548).margin(1e-3));
        REQUIRE(spine.max == Approx(164.176).margin(1e-3));
    });
}

TEST_CASE("Algorithm 5 leaves alone what does not match", "[flips]") {
    forEachFigure([](const Figure& figure) {
        for (int shortOne = 0; shortOne < 3; ++shortOne) {
            Constructed c = figure.construct(shortOne == 0 ? 0.29 : 0.5, shortOne == 1 ? 0.29 : 0.5,
                                             shortOne == 2 ? 0.29 : 0.5);
            REQUIRE(!chooseExtraSlice(c.load(), c.octahedron()).matches);
        }
        Constructed outside = figure.construct(0.5, 0.5, 0.5);
        outside.setOutside(figure.v1());
        REQUIRE(!chooseExtraSlice(outside.load(), outside.octahedron()).matches);

        Constructed turned = figure.construct(0.5, 0.5, 0.5);
        turned.setMove(figure.v3(), turned.direction(figure.v3(), figure.v2()), 0.5);
        REQUIRE(!chooseExtraSlice(turned.load(), turned.octahedron()).matches);
    });
}

TEST_CASE("a fourth manifold vertex is a conflict, flipped only if it hardly moves and gains", "[flips]") {
    forEachFigure([](const Figure& figure) {
        for (int fourth : {figure.v5(), figure.v6()}) {
            for (int direction = 0; direction < bcc::kDirections; ++direction) {
                Constructed far = figure.construct(0.5, 0.5, 0.5);
                far.setMove(fourth, direction, 0.31);
                const ExtraFlip kept = chooseExtraSlice(far.load(), far.octahedron());
                REQUIRE(kept.conflict);
                REQUIRE(kept.slice == bcc::S);

                Constructed near = figure.construct(0.5, 0.5, 0.5);
                near.setMove(fourth, direction, 0.2);
                const LocalVertices& local = near.load();
                const ExtraFlip flipped = chooseExtraSlice(local, near.octahedron());
                REQUIRE(flipped.conflict);
                Angles before, after;
                for (const auto& tet : bcc::kSliceTets[bcc::S]) {
                    if (std::any_of(tet, tet + 4,
                                    [&](int v) { return !local.manifold(near.octahedron()[v]); })) {
                        before.add(local, near.octahedron(), tet);
                    }
                }
                for (const auto& tet : bcc::kSliceTets[flipped.slice]) {
                    if (std::any_of(tet, tet + 4,
                                    [&](int v) { return !local.manifold(near.octahedron()[v]); })) {
                        after.add(local, near.octahedron(), tet);
                    }
                }
                // The tet that makes Algorithm 5 necessary is there, so a flip must help.
                REQUIRE(before.min < 8.55);
                REQUIRE(flipped.slice != bcc::S);
                REQUIRE(!after.inverted);
                REQUIRE(after.min > before.min);
            }
        }
        Constructed both = figure.construct(0.5, 0.5, 0.5);
        both.setMove(figure.v5(), 0, 0.1);
        both.setMove(figure.v6(), 0, 0.1);
        const ExtraFlip flip = chooseExtraSlice(both.load(), both.octahedron());
        REQUIRE(flip.conflict);
        REQUIRE(flip.slice == bcc::S);
    });
}

TEST_CASE("Algorithm 4's slice keeps the bound at both ends of every spine", "[flips]") {
    // The lattices and axes are the same up to a motion; all directions of the four moves, at the ends of
    // their range.
    const bcc::Lattice lattice = GENERATE(bcc::A, bcc::B);
    const int axis = GENERATE(0, 1, 2);
    const int stride = lattice == bcc::A && axis == 0 ? 1 : 7;
    Angles worst;
    for (int directions = 0; directions < 4096; directions += stride) {
        for (int lengths = 1; lengths < 16; ++lengths) {
            Constructed c(lattice, axis);
            for (int r = 0; r < 4; ++r) {
                c.setMove(2 + r, directions >> (3 * r) & 7, (lengths >> r & 1) ? 0.5 : 0.0);
            }
            const int inside = (directions + lengths) & 1;
            c.setOutside(1 - inside);
            const LocalVertices& local = c.load();
            const bcc::Slice slice = chooseActiveSlice(local, c.octahedron());
            REQUIRE(slice != bcc::S);
            for (const auto& tet : bcc::kSliceTets[slice]) {
                if (std::find(tet, tet + 4, inside) != tet + 4) worst.add(local, c.octahedron(), tet);
            }
        }
    }
    REQUIRE(!worst.inverted);
    REQUIRE(worst.min > 11.47); // equation (24)
    REQUIRE(worst.max < 157.49);
    if (stride == 1) REQUIRE(worst.min < 12.5);
}

TEST_CASE("a tet of at most three moving vertices keeps the bound, and two triples alone come near it",
          "[flips]") {
    // Equations (21) and (22), at the ends of the parameters' range. v1 is still; a vertex never moves toward
    // a moving one.
    Constructed c(bcc::A, 0);
    const LocalOctahedron o = c.octahedron();
    const auto& tet = bcc::kSliceTets[bcc::S][1]; // v1 v4 v2 v3
    const int moving[3] = {tet[1], tet[2], tet[3]};
    double min = 180.0, max = 0.0;
    int bad = 0;
    for (int directions = 0; directions < 512; ++directions) {
        double tripleMin = 180.0, tripleMax = 0.0;
        for (int lengths = 0; lengths < 8; ++lengths) {
            Vec3d p[4] = {homeOf(o[tet[0]]), {}, {}, {}};
            bool valid = true;
            for (int i = 0; i < 3; ++i) {
                const int d = directions >> (3 * i) & 7;
                const double alpha = (lengths >> i & 1) ? 0.5 : 0.0;
                const Vec3d edge(0.5 * bcc::sign(d, 0), 0.5 * bcc::sign(d, 1), 0.5 * bcc::sign(d, 2));
                const Vec3d home = homeOf(o[moving[i]]);
                p[i + 1] = home + alpha * edge;
                for (int j = 0; j < 3; ++j) {
                    if (alpha > 0.0 && home + edge == homeOf(o[moving[j]])) valid = false;
                }
            }
            if (!valid) continue;
            REQUIRE(signedVolume6(p[0], p[1], p[2], p[3]) > 0.0);
            for (double angle : dihedralAngles(p[0], p[1], p[2], p[3])) {
                tripleMin = std::min(tripleMin, angle);
                tripleMax = std::max(tripleMax, angle);
            }
        }
        bad += tripleMin < 13.26 || tripleMax > 157.59;
        min = std::min(min, tripleMin);
        max = std::max(max, tripleMax);
    }
    REQUIRE(min == Approx(8.548).margin(1e-3));
    REQUIRE(max == Approx(164.176).margin(1e-3));
    REQUIRE(bad == 2);
}

TEST_CASE("a flip survives its code", "[flips]") {
    for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
                for (int vertex : {0, 1, 255, 511}) {
                    const Flip flip = Flips::decode(Flips::encode({lattice, axis, slice, vertex}));
                    REQUIRE(flip.lattice == lattice);
                    REQUIRE(flip.axis == axis);
                    REQUIRE(flip.slice == slice);
                    REQUIRE(flip.vertex == vertex);
                }
            }
        }
    }
}

} // namespace vdbtet::test
