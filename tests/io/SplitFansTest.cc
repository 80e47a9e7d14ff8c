/// A surface of triangles is a manifold once its fans are split, whatever the solid.
#include "io/SplitFans.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace vdbtet::test {

namespace {

struct Surface {
    std::vector<Vec3d> points;
    std::vector<Triangle> triangles;
};

/// The faces of some tets, outwards, that are of one tet.
Surface surfaceOf(const std::vector<Vec3d>& points, const std::vector<Tet>& tets) {
    std::map<std::array<std::int64_t, 3>, std::vector<Triangle>> faces;
    for (const Tet& t : tets) {
        for (const Triangle& face : {Triangle{t[1], t[2], t[3]}, Triangle{t[0], t[3], t[2]},
                                     Triangle{t[0], t[1], t[3]}, Triangle{t[0], t[2], t[1]}}) {
            Triangle sorted = face;
            std::sort(sorted.begin(), sorted.end());
            faces[sorted].push_back(face);
        }
    }
    Surface surface{points, {}};
    for (const auto& [corners, both] : faces) {
        if (both.size() == 1) surface.triangles.push_back(both[0]);
    }
    return surface;
}

/// Hold that two triangles meet at each edge, one each way, and one closed fan at each point.
void requireManifold(const Surface& surface) {
    std::map<std::pair<std::int64_t, std::int64_t>, int> edges;
    std::map<std::int64_t, std::map<std::int64_t, std::int64_t>> links;
    for (const Triangle& t : surface.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++edges[{t[i], t[(i + 1) % 3]}];
            links[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
        }
    }
    for (const auto& [edge, count] : edges) {
        REQUIRE(count == 1);
        REQUIRE(edges.count({edge.second, edge.first}) == 1);
    }
    for (auto& [point, link] : links) {
        const std::size_t size = link.size();
        std::size_t steps = 0;
        for (std::int64_t at = link.begin()->first; steps == 0 || at != link.begin()->first; ++steps) {
            REQUIRE(steps < size);
            at = link.at(at);
        }
        REQUIRE(steps == size);
    }
}

/// Split, and hold what is promised.
/// @return how many points were added
std::int64_t requireSplit(Surface surface) {
    const Surface before = surface;
    const std::int64_t added = splitFans(surface.points, surface.triangles);
    requireManifold(surface);
    REQUIRE(surface.points.size() == before.points.size() + std::size_t(added));
    CHECK(std::equal(before.points.begin(), before.points.end(), surface.points.begin()));
    REQUIRE(surface.triangles.size() == before.triangles.size());
    for (std::size_t t = 0; t < before.triangles.size(); ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto is = std::size_t(surface.triangles[t][i]), was = std::size_t(before.triangles[t][i]);
            CHECK(surface.points[is] == before.points[was]);
            CHECK((is == was || is >= before.points.size()));
        }
    }
    return added;
}

/// A point about the z axis, by its angle in degrees.
Vec3d beside(double degrees) {
    const double angle = degrees * 0.017453292519943295;
    return {std::cos(angle), std::sin(angle), 0.0};
}

} // namespace

TEST_CASE("a surface that is a manifold stays as it is") {
    CHECK(requireSplit(surfaceOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}})) == 0);
}

TEST_CASE("tets that touch at a point or along an edge come apart") {
    const std::vector<Vec3d> atPoint = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                                        {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    CHECK(requireSplit(surfaceOf(atPoint, {{0, 1, 2, 3}, {0, 5, 4, 6}})) == 1);
    for (const double turn : {0.0, 50.0, 170.0, 290.0}) {
        for (const int wedges : {2, 3}) {
            std::vector<Vec3d> points = {{0, 0, -1}, {0, 0, 1}};
            std::vector<Tet> tets;
            for (int w = 0; w < wedges; ++w) {
                const auto first = std::int64_t(points.size());
                points.push_back(beside(turn + 120.0 * w));
                points.push_back(beside(turn + 120.0 * w + 70.0));
                tets.push_back({0, first, first + 1, 1});
            }
            CHECK(requireSplit(surfaceOf(points, tets)) == 2 * (wedges - 1));
        }
    }
}

TEST_CASE("wedges that are one fan at both ends of their edge come apart at both") {
    // The edge from 0 to 1, with a ring of six points about it, and a point below and one above.
    const std::vector<Vec3d> points = {{0, 0, -1},  {0, 0, 1},   beside(0),   beside(60), beside(120),
                                       beside(180), beside(240), beside(300), {0, 0, -3}, {0, 0, 3}};
    std::vector<Tet> tets;
    // About the edge two wedges, whose tets have neighbours all around 8 and 0, and 1 and 9.
    for (const int from : {0, 2, 3, 5}) tets.push_back({0, 2 + from, 2 + (from + 1) % 6, 1});
    for (int from = 0; from < 6; ++from) {
        tets.push_back({8, 2 + from, 2 + (from + 1) % 6, 0});
        tets.push_back({1, 2 + from, 2 + (from + 1) % 6, 9});
    }
    // The gaps between the wedges end at an edge each, and there the surface touches itself, too.
    CHECK(requireSplit(surfaceOf(points, tets)) == 2 + 4);
}

TEST_CASE("surfaces of noise are manifolds once their fans are split") {
    std::int64_t added = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        for (const auto& grid :
             {levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 14, 1.5)), randomSigns(16, seed)}) {
            for (const Boundary boundary : {Boundary::Raw, Boundary::Fill, Boundary::Manifold}) {
                Options options = atVoxels(1.0);
                options.boundary = boundary;
                const Meshed meshed = meshOf(*grid, options);
                const std::int64_t split = requireSplit(surfaceOf(meshed.mesh.points, meshed.mesh.tets));
                CHECK((split > 0) == (boundary != Boundary::Manifold));
                added += split;
            }
        }
    }
    CHECK(added > 1000);
}

} // namespace vdbtet::test
