/// Fields made to have the worst angles: meshes come within a degree of the bounds of docs/angles.md.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"
#include "support/ThirdStages.h"
#include "tets/TileTets.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <set>

namespace vdbtet::test {

namespace {

/// The extremes of what it is shown.
struct Extremes {
    double min = 180.0, max = 0.0;

    void add(double least, double greatest) {
        min = std::min(min, least);
        max = std::max(max, greatest);
    }
    void requireNear(const AngleBound& bound) const {
        CHECK(min > bound.lo);
        CHECK(min < bound.lo + 1.0);
        CHECK(max < bound.hi);
        CHECK(max > bound.hi - 1.0);
    }
};

/// The extremes over meshes of random fields whose report states a bound.
template <typename MakeGrid>
Extremes worstOf(const AngleBound& bound, const Options& options, int seeds, const MakeGrid& makeGrid) {
    Extremes extremes;
    for (int seed = 1; seed <= seeds; ++seed) {
        CAPTURE(seed);
        try {
            const Meshed meshed = meshOf(*makeGrid(std::uint64_t(seed)), options);
            if (meshed.report.angleMin != bound.lo || meshed.report.angleMax != bound.hi) continue;
            requireClean(meshed.mesh, meshed.report);
            extremes.add(meshed.report.angles.min, meshed.report.angles.max);
        } catch (const NoSurface&) { // few vertices are inside
        }
    }
    return extremes;
}

/// The part below a plane of a box of 32 voxels around the tile at the origin.
openvdb::FloatGrid::Ptr halfBox(const Vec3d& normal, double offset) {
    Shape shape = box(Vec3d(-12.0), Vec3d(20.0));
    shape.distance = [=, inBox = shape.distance](const Vec3d& p) {
        return std::max(inBox(p), normal.dot(p) - offset);
    };
    return levelSet(shape);
}

/// The flips of Algorithm 4 alone.
Flips activeFlips(const ThirdStages& stages) {
    const Flips all = stages.flips.flips();
    Flips active;
    active.first.push_back(0);
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        std::set<int> candidates;
        for (const FlipCandidate& c : stages.flips.candidates(TileRef(t))) candidates.insert(c.spine);
        all.forEach(TileRef(t), [&](const Flip& flip) {
            const int spine = (flip.lattice * 3 + flip.axis) << 9 | flip.vertex;
            if (candidates.count(spine) == 0) active.codes.push_back(Flips::encode(flip));
        });
        active.first.push_back(std::int64_t(active.codes.size()));
    }
    return active;
}

/// The extremes of the tets that the tile at the origin owns, far from where the plane ends.
Extremes extremesInside(const ThirdStages& stages, const Flips& flips) {
    const auto& all = stages.layout.surfaceTiles;
    const auto tile = TileRef(std::find(all.begin(), all.end(), openvdb::Coord(0)) - all.begin());
    LocalStates states;
    LocalPositions positions;
    TileTets tets(stages.vertices, flips);
    states.load(stages.vertices, tile);
    positions.load(stages.vertices, tile);
    tets.load(tile, states);
    Extremes extremes;
    const auto add = [&](int a, int b, int c, int d) {
        for (const double angle : dihedralAngles(positions[a], positions[b], positions[c], positions[d]))
            extremes.add(angle, angle);
    };
    const auto addFlipped = [&](const LocalTet& tet) {
        add(tet.vertex(0), tet.vertex(1), tet.vertex(2), tet.vertex(3));
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (int number = 0; number < 4; ++number) {
            const auto& tet = bcc::kSliceTets[bcc::S][number];
            tets.latticeTets(axis, number).forEach([&](int n) {
                const LocalOctahedron o = localOctahedron(bcc::A, axis, localIndex(bcc::A, n));
                add(o[tet[0]], o[tet[1]], o[tet[2]], o[tet[3]]);
            });
        }
        tets.flippedSpines(axis).forEach([&](int n) { tets.forEachTetOf(axis, n, addFlipped); });
    }
    tets.forEachTetOfB(addFlipped);
    return extremes;
}

/// Planes near the two that the proof finds to be the worst, where a vertex ties between two labels.
Extremes worstOnPlanes(double tau, bool withQualityFlips) {
    Extremes extremes;
    for (Vec3d normal : {Vec3d(1.0, 0.003, 0.002), Vec3d(1.0, 0.997, 0.002)}) {
        normal.normalize();
        const double m = 0.5 * (normal.x() + normal.y() + normal.z());
        const auto grid = halfBox(normal, normal.dot(Vec3d(4.0)) + tau * m);
        const ThirdStages stages(*grid, 1.0, tau);
        const Extremes found =
            extremesInside(stages, withQualityFlips ? stages.flips.flips() : activeFlips(stages));
        extremes.add(found.min, found.max);
    }
    return extremes;
}

} // namespace

TEST_CASE("cuts in the middle of edges come within a degree of the bound for any volume", "[property]") {
    for (const int tiger : {1, 2, 3}) {
        CAPTURE(tiger);
        worstOf(kAlways, atVoxels(2.0, tiger), 3, [](std::uint64_t seed) {
            return middleCuts(10, seed, 0.7);
        }).requireNear(kAlways);
    }
}

TEST_CASE("cuts in the middle of edges come within a degree of the bound for runs without conflict",
          "[property]") {
    worstOf(kNoConflict, atVoxels(2.0, 2), 200, [](std::uint64_t seed) {
        return middleCuts(3, seed, 0.7);
    }).requireNear(kNoConflict);
}

TEST_CASE("conflicts that are all flipped leave a bound, and meshes come within a degree of it",
          "[property]") {
    const auto conflict = middleCuts(4, 34, 0.7, 0.6);
    const Report report = meshOf(*conflict, atVoxels(2.0, 2)).report;
    REQUIRE(report.conflicts > 0);
    REQUIRE(report.conflicts == report.lastResortFlips);
    worstOf(kLastResort, atVoxels(2.0, 2), 200, [&](std::uint64_t seed) {
        const auto grid = shifted(*middleCuts(3, seed, 0.7), openvdb::Coord(32, 0, 0));
        grid->merge(*conflict->deepCopy());
        return grid;
    }).requireNear(kLastResort);
}

TEST_CASE("tets within a degree of what the guard lets pass are passed", "[property]") {
    worstOf(kGuarded, atVoxels(1.0, 3), 2, [](std::uint64_t seed) {
        return levelSet(noiseBall(seed == 1 ? 262 : 313, Vec3d(0.1, 0.2, 0.3), 6.0, 3.0));
    }).requireNear(kGuarded);
}

TEST_CASE("planes come within a degree of version 3's bounds for planes without quality flips",
          "[property]") {
    worstOnPlanes(0.5, false).requireNear({17.4, 153.5});
    worstOnPlanes(0.6, false).requireNear({18.6, 149.1});
    worstOnPlanes(0.7, false).requireNear({19.2, 145.1});
    worstOnPlanes(0.75, false).requireNear({19.3, 143.2});
    worstOnPlanes(0.77, false).requireNear({19.4, 142.5});
}

TEST_CASE("with quality flips the same planes have angles as near to 90 degrees as the search found",
          "[property]") {
    worstOnPlanes(0.7, true).requireNear({26.4, 132.2});
}

} // namespace vdbtet::test
