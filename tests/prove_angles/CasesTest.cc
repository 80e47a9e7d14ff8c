/// The configurations that the proof goes through are those that the mesher makes.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include "prove_angles/TigerCases.h"
#include "prove_angles/TigerProblems.h"

#include "destinations/Destinations.h"
#include "flips/Flips.h"
#include "flips/Slices.h"
#include "tets/TileTets.h"

#include <algorithm>
#include <map>
#include <set>

namespace vdbtet::test {

using namespace proof;

namespace {

Site siteOf(const LocalVertices& vertices, int local) {
    const int n = bitOf(local), lattice = latticeOf(local);
    Site site = proof::siteOf({bcc::Lattice(lattice), PaddedMask::x(n), PaddedMask::y(n), PaddedMask::z(n)});
    switch (vertices.state(local)) {
    case State::Inside:
        site.label = Label::Inside;
        break;
    case State::Outside:
        site.label = Label::Outside;
        break;
    case State::Manifold:
        site.label = Label::Manifold;
        site.direction = vertices.destinations().directions[vertices.moveOf(local)];
        break;
    }
    return site;
}

template <typename Locals>
Configuration configurationOf(const LocalVertices& vertices, const Locals& locals) {
    Configuration sites;
    for (int local : locals) sites.push_back(siteOf(vertices, local));
    return sites;
}

/// Sites relative to the first one, in their order.
std::vector<int> exactly(const Configuration& sites) {
    std::vector<int> numbers;
    for (const Site& site : sites) {
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(site.at[axis] - sites[0].at[axis]);
        numbers.push_back(int(site.label));
        numbers.push_back(site.direction);
    }
    numbers.push_back(sites[0].at[0] & 1);
    return numbers;
}

std::set<Key> keysOf(const std::vector<Counted>& kinds) {
    std::set<Key> keys;
    for (const Counted& kind : kinds) keys.insert(keyOf(kind.configuration));
    return keys;
}

/// What is met in the meshes of random cuts.
struct Met {
    std::set<Key> tets, active, flipped;
};

void visitMesh(std::uint64_t seed, double insideShare, Met& met) {
    static const std::map<std::vector<int>, bcc::Slice> kFigures = [] {
        std::map<std::vector<int>, bcc::Slice> slices;
        for (const Figure& figure : figures()) slices[exactly(figure.octahedron)] = figure.slice;
        return slices;
    }();
    const auto grid = randomCuts(16, seed, insideShare);
    Stages stages(*grid, 2.0);
    const Destinations destinations =
        findDestinations(stages.field, stages.layout, stages.cuts.arrows, stages.labels, stages.interrupt);
    for (float distance : destinations.distances) REQUIRE(distance <= float(kLongestMove));
    const Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
    const Flips flips = chooseFlips(vertices, 2, stages.interrupt);
    LocalVertices local(vertices);
    TileTets tets(vertices, flips);
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        local.load(TileRef(t));
        tets.load(TileRef(t), local);
        tets.forEachCode([&](TetCode code) {
            const LocalTet tet = tets.tetOf(code);
            if (tet.slice != bcc::S) return;
            Configuration corners;
            int manifold = 0;
            for (int i = 0; i < 4; ++i) {
                corners.push_back(siteOf(local, tet.vertex(i)));
                manifold += corners.back().label == Label::Manifold;
            }
            if (manifold > 0) met.tets.insert(keyOf(corners));
        });
        flips.forEach(TileRef(t), [&](const Flip& flip) {
            const LocalOctahedron octahedron =
                localOctahedron(flip.lattice, flip.axis, localIndex(flip.lattice, flip.vertex));
            const Configuration sites = configurationOf(local, octahedron);
            const bool isActive = sites[0].label != Label::Manifold && sites[1].label != Label::Manifold;
            if (isActive) {
                met.active.insert(keyOf(sites));
                return;
            }
            const auto manifold = std::count_if(sites.begin(), sites.end(),
                                                [](const Site& s) { return s.label == Label::Manifold; });
            if (manifold > 3) return; // the last resort
            const auto figure = kFigures.find(exactly(sites));
            REQUIRE(figure != kFigures.end());
            REQUIRE(figure->second == flip.slice);
            met.flipped.insert(keyOf(sites));
            for (int vertex : octahedron) {
                if (local.manifold(vertex))
                    REQUIRE(destinations.distances[local.moveOf(vertex)] >= float(kExtremeMove));
            }
        });
    }
}

} // namespace

TEST_CASE("the mesher makes the configurations that are proved, all of them and no others", "[prove]") {
    Met met;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) visitMesh(seed, seed % 2 == 0 ? 0.5 : 0.8, met);
    const std::set<Key> tets = keysOf(movedTets()), active = keysOf(activeOctahedra());
    CHECK(met.tets == tets);
    CHECK(std::includes(active.begin(), active.end(), met.active.begin(), met.active.end()));
    CHECK(met.active.size() > active.size() / 2);
    CHECK(met.flipped.size() == 1); // all figures are alike
}

TEST_CASE("where the surface is a plane the manifold vertices are those near enough to it", "[prove]") {
    // PlaneProblems.h relies on it, for any threshold; the mesher's is a half.
    Random random(7);
    for (int i = 0; i < 8; ++i) {
        openvdb::Vec3d normal = random.inBox(-1.0, 1.0);
        normal.normalize();
        const double offset = random.uniform(-1.0, 1.0);
        const auto height = [&](const openvdb::Vec3d& at) { return normal.dot(at) + offset; };
        const auto greatestOf = [](const openvdb::Vec3d& at) {
            return std::max({std::abs(at.x()), std::abs(at.y()), std::abs(at.z())});
        };
        // A half-space in a box, since an inside must end somewhere.
        const auto grid = openvdb::FloatGrid::create(1.0f);
        const openvdb::CoordBBox voxels(openvdb::Coord(-20), openvdb::Coord(20));
        for (auto voxel = voxels.begin(); voxel; ++voxel) {
            const openvdb::Vec3d at = (*voxel).asVec3d();
            grid->tree().setValue(*voxel, float(std::max(height(at), greatestOf(at) - 17.0)));
        }
        // The lattice has every other voxel, so short edges are diagonals of voxels.
        const Stages stages(*grid, 2.0);
        const double m = std::abs(normal.x()) + std::abs(normal.y()) + std::abs(normal.z());
        int manifold = 0;
        for (std::size_t t = 0; t < stages.tiles.size(); ++t) {
            for (int lattice = 0; lattice < 2; ++lattice) {
                for (int n = 0; n < TileMask::kSize; ++n) {
                    const openvdb::Vec3d vertex =
                        stages.layout.origin(TileRef(t)) + openvdb::Vec3d(n >> 6, n >> 3 & 7, n & 7);
                    const openvdb::Vec3d at = 2.0 * vertex + openvdb::Vec3d(lattice);
                    const double fraction = height(at) / m;
                    if (greatestOf(at) > 12.0 || std::abs(std::abs(fraction) - 0.5) < 1e-5) continue;
                    const bool expected = std::abs(fraction) < 0.5;
                    REQUIRE(stages.labels.manifold[t][lattice].test(n) == expected);
                    manifold += expected;
                }
            }
        }
        REQUIRE(manifold > 100);
    }
}

TEST_CASE("all tets are alike, and all octahedra", "[prove]") {
    std::set<Key> tets, octahedra;
    for (const auto& lattice : bcc::kOctahedra) {
        for (const bcc::Octahedron& octahedron : lattice) {
            Configuration sites;
            for (const bcc::Vertex& vertex : octahedron) sites.push_back(proof::siteOf(vertex));
            octahedra.insert(keyOf(sites));
            for (const auto& numbers : bcc::kSliceTets[bcc::S]) {
                tets.insert(
                    keyOf({sites[numbers[0]], sites[numbers[1]], sites[numbers[2]], sites[numbers[3]]}));
            }
        }
    }
    REQUIRE(tets.size() == 1);
    REQUIRE(octahedra.size() == 1);
}

TEST_CASE("one tet has 480 ways to move, of which two are Algorithm 5's", "[prove]") {
    std::set<Key> worst;
    for (const Figure& figure : figures()) worst.insert(keyOf(figure.worstTet()));
    REQUIRE(figures().size() == 2 * 3 * 2 * 4 * 2);
    REQUIRE(worst.size() == 1);
    int ways = 0, worstWays = 0;
    for (int labels = 1; labels < 8; ++labels) { // the last corner is still
        Configuration tet;
        int manifold = 0;
        for (int i = 0; i < 4; ++i) {
            tet.push_back(proof::siteOf(bcc::kOctahedra[0][0][bcc::kSliceTets[bcc::S][0][i]]));
            if (labels >> i & 1) tet[i].label = Label::Manifold;
            manifold += labels >> i & 1;
        }
        for (int directions = 0; directions < 1 << (3 * manifold); ++directions) {
            int rest = directions;
            for (Site& site : tet) {
                if (site.label != Label::Manifold) continue;
                site.direction = rest & 7;
                rest >>= 3;
            }
            ways += proof::allowed(tet);
            worstWays += proof::allowed(tet) && worst.count(keyOf(tet)) > 0;
        }
    }
    REQUIRE(ways == 480);
    REQUIRE(worstWays == 2);
}

TEST_CASE("labels rule out moves toward moving vertices, and signs that contradict each other", "[prove]") {
    using proof::allowed;
    const Site a{{0, 0, 0}, Label::Inside, -1}, b{{1, 1, 1}, Label::Outside, -1};
    REQUIRE(!allowed({a, b})); // a cut short edge without a manifold end
    REQUIRE(allowed({{{0, 0, 0}, Label::Manifold, 7}, b}));
    REQUIRE(!allowed({{{0, 0, 0}, Label::Manifold, 7}, {{1, 1, 1}, Label::Manifold, 7}}));
    // Both move to (1,1,1), so both are of the sign that this one is not of.
    REQUIRE(allowed({{{0, 0, 0}, Label::Manifold, 7}, {{2, 0, 0}, Label::Manifold, 3}, b}));
    // They move to the neighbours (1,1,1) and (2,2,2), of which one is next to a vertex inside, one to one
    // outside.
    REQUIRE(!allowed({{{0, 0, 0}, Label::Manifold, 7},
                      {{3, 3, 1}, Label::Manifold, 1},
                      {{2, 0, 2}, Label::Inside, -1},
                      {{3, 1, 3}, Label::Outside, -1}}));
}

TEST_CASE("Algorithm 4 picks a good slice if there is one", "[prove]") {
    // proveTheorem() relies on it: least and greatest angles about the policy's angle and a bound, ties
    // included.
    constexpr double kMax = 157.49;
    std::vector<SliceQuality> qualities;
    for (double min : {5.0, kMinAngle - 2e-5, kMinAngle - 4e-6, kMinAngle + 4e-6, kMinAngle + 1.5e-5, 40.0}) {
        for (double max : {100.0, kMax - 1.5e-5, kMax - 4e-6, kMax + 4e-6, 170.0}) {
            for (bool inverted : {false, true}) {
                const auto cosine = [](double degrees) {
                    return std::cos(degrees * std::acos(-1.0) / 180.0);
                };
                qualities.push_back({inverted, cosine(max), cosine(min)});
            }
        }
    }
    const auto isGood = [](const SliceQuality& q, double slack) {
        const double min = std::acos(q.maxCos) * 180.0 / std::acos(-1.0),
                     max = std::acos(q.minCos) * 180.0 / std::acos(-1.0);
        return !q.inverted && min > kMinAngle + slack && max < kMax - slack;
    };
    int met = 0;
    for (const SliceQuality& a : qualities) {
        for (const SliceQuality& b : qualities) {
            if (!isGood(a, kTieAngle) && !isGood(b, kTieAngle)) continue;
            ++met;
            REQUIRE(isGood(better(b, a) ? b : a, 0.0));
        }
    }
    REQUIRE(met > 100);
}

} // namespace vdbtet::test
