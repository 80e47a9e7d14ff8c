/// The guard of version 3: what it leaves, and that it ends where a fresh start with its flags would.
#include "guard/BadTets.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"
#include "support/ThirdStages.h"

#include <algorithm>
#include <numeric>

namespace vdbtet::test {

namespace {

std::vector<TileRef> allTiles(const ThirdStages& stages) {
    std::vector<TileRef> tiles(stages.layout.surfaceTiles.size());
    std::iota(tiles.begin(), tiles.end(), 0);
    return tiles;
}

struct Bad {
    std::vector<VertexRef> vertices;
    std::int64_t tiles; ///< with a bad tet in the mesh
};

Bad findBad(ThirdStages& stages) {
    const std::vector<TileRef> tiles = allTiles(stages);
    std::vector<char> hasBad(tiles.size());
    Bad bad;
    bad.vertices = verticesOfBadTets(stages.vertices, stages.flips.flips(), tiles, hasBad, stages.interrupt);
    bad.tiles = std::count(hasBad.begin(), hasBad.end(), 1);
    return bad;
}

void requireGuarded(const openvdb::FloatGrid& grid, double voxels, double tau, bool mustFlag) {
    CAPTURE(voxels, tau);
    ThirdStages stages(grid, voxels, tau);
    const bool hadBad = !findBad(stages).vertices.empty();
    const Guarded guarded = stages.guard();
    CHECK((guarded.rounds > 0) == hadBad);
    if (mustFlag) CHECK(guarded.rounds > 0);
    std::int64_t count = 0;
    for (const auto& masks : guarded.flagged) count += masks[0].count() + masks[1].count();
    CHECK(guarded.count == count);

    std::int64_t unflagged = 0;
    const Bad left = findBad(stages);
    CHECK(guarded.tilesWithBad == left.tiles);
    for (const VertexRef& v : left.vertices) unflagged += !guarded.flagged[v.tile][v.lattice].test(v.vertex);
    CHECK(unflagged == 0);

    const ThirdStages fresh(grid, voxels, tau, guarded.flagged);
    REQUIRE(fresh.cuts.arrows.tiles == stages.cuts.arrows.tiles);
    for (const TileRef t : fresh.cuts.arrows.tiles)
        REQUIRE(*fresh.cuts.arrows.of[t] == *stages.cuts.arrows.of[t]);
    REQUIRE(fresh.labels.manifold == stages.labels.manifold);
    REQUIRE(fresh.destinations.first == stages.destinations.first);
    REQUIRE(fresh.destinations.offsets == stages.destinations.offsets);
    const Flips one = fresh.flips.flips(), two = stages.flips.flips();
    REQUIRE(one.first == two.first);
    REQUIRE(one.codes == two.codes);
    CHECK(one.active == two.active);
    CHECK(one.quality == two.quality);
}

} // namespace

TEST_CASE("the guard leaves no bad tet but those of flagged vertices, and what a fresh start would give",
          "[guard]") {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        for (const double tau : {0.5, 0.7, 0.77}) {
            requireGuarded(*levelSet(noiseBall(seed, Vec3d(0.1, 0.2, 0.3), 11.0, 2.0)), 1.0, tau, true);
            requireGuarded(*randomSigns(14, seed), 0.7, tau, true);
        }
        requireGuarded(*randomCuts(12, seed, 0.6), 2.0, 0.7, true);
    }
}

TEST_CASE("nothing is flagged where the lattice resolves a smooth shape", "[guard]") {
    for (const double radius : {6.3, 11.0, 20.5})
        requireGuarded(*levelSet(sphere(Vec3d(0.1, 0.2, 0.3), radius)), 1.0, 0.7, false);
    const Report report = meshOf(*levelSet(sphere(Vec3d(0.1, 0.2, 0.3), 20.5)), atVoxels(1.0, 3)).report;
    CHECK(report.flagged == 0);
    CHECK(report.guardRounds == 0);
    CHECK(report.qualityFlips > 0);
}

TEST_CASE("version 3 has better angles than version 2 on resolved shapes", "[guard]") {
    for (const double radius : {9.7, 13.2, 20.5}) {
        CAPTURE(radius);
        const auto grid = levelSet(sphere(Vec3d(0.1, 0.2, 0.3), radius));
        const Meshed three = meshOf(*grid, atVoxels(1.0, 3));
        CHECK(three.report.angles.min > 24.0);
        CHECK(three.report.angles.max < 140.0);
        const MeshFigures figures = requireClean(three.mesh, three.report);
        CHECK(figures.components == 1);
        CHECK(figures.euler == 2);
    }
}

TEST_CASE("what version 2 keeps of thin parts, version 3 keeps", "[guard]") {
    for (const double tube : {1.2, 1.4, 1.7, 2.2}) {
        CAPTURE(tube);
        const auto grid = levelSet(torus(Vec3d(0.1, 0.2, 0.3), 12.0, tube));
        const Meshed two = meshOf(*grid, atVoxels(1.0, 2)), three = meshOf(*grid, atVoxels(1.0, 3));
        const MeshFigures was = requireClean(two.mesh, two.report),
                          is = requireClean(three.mesh, three.report);
        CHECK(is.components == was.components);
        CHECK(is.euler == was.euler);
        CHECK(is.volume > 0.85 * was.volume);
    }
}

TEST_CASE("version 3 marches over unresolved shapes as over any other", "[guard]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const auto grid = levelSet(noiseBall(seed, Vec3d(0.1, 0.2, 0.3), 11.0, 1.5));
        for (const bool grade : {false, true}) {
            Options options = atVoxels(1.0, 3);
            options.grade = grade;
            const Meshed meshed = meshOf(*grid, options);
            requireClean(meshed.mesh, meshed.report);
            CHECK(meshed.report.flagged > 0);
            CHECK(meshed.report.guardRounds > 0);
            CHECK(meshed.report.extraFlips + meshed.report.lastResortFlips + meshed.report.conflicts == 0);
        }
    }
}

} // namespace vdbtet::test
