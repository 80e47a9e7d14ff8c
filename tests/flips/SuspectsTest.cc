/// Vertices at which the boundary may be no surface, by the states around them.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"
#include "support/ThirdStages.h"

#include "repair/BoundaryCheck.h"

namespace vdbtet::test {

namespace {

/// All manifold vertices.
std::vector<Suspects> everyone(const Vertices& vertices) {
    std::vector<Suspects> all;
    for (TileRef t = 0; t < vertices.layout.surfaceCount(); ++t)
        all.push_back({t, vertices.labels.manifold[std::size_t(t)]});
    return all;
}

std::int64_t count(const std::vector<Suspects>& suspects) {
    std::int64_t sum = 0;
    for (const Suspects& one : suspects) sum += one.vertices[bcc::A].count() + one.vertices[bcc::B].count();
    return sum;
}

/// Hold that all vertices whose stars are bad are found from the suspects.
/// @return how many are bad
std::size_t requireAllFound(const Vertices& vertices, const Flips& flips, Interrupt& interrupt) {
    Flips thorough = flips;
    thorough.suspects = everyone(vertices);
    const auto bad = findPinched(vertices, thorough, interrupt);
    CHECK(findPinched(vertices, flips, interrupt) == bad);
    return bad.size();
}

} // namespace

TEST_CASE("all vertices where the boundary is pinched are among the suspects") {
    std::size_t bad = 0;
    std::int64_t lastResort = 0;
    std::vector<openvdb::FloatGrid::Ptr> grids = {levelSet(gyroidBall({0.1, 0.2, 0.3}, 14, 12, 1.5)),
                                                  levelSet(twoBalls({0.1, 0.2, 0.3}, 6.0, 12.3))};
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        if (seed <= 2) grids.push_back(levelSet(noiseBall(seed, {0.1, 0.2, 0.3}, 12, 1.5)));
        if (seed <= 2) grids.push_back(randomSigns(14, seed));
        grids.push_back(randomCuts(12, seed, seed % 2 == 1 ? 0.5 : 0.7));
    }
    for (const auto& grid : grids) {
        for (const double voxels : {1.0, 2.0}) {
            const Stages stages(*grid, voxels);
            Interrupt interrupt(nullptr);
            const Destinations destinations =
                findDestinations(stages.field, stages.layout, stages.cuts.arrows, stages.labels, interrupt);
            const Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
            for (const int version : {1, 2}) {
                const Flips flips = chooseFlips(vertices, version, interrupt);
                REQUIRE(flips.suspects);
                lastResort += flips.lastResort;
                bad += requireAllFound(vertices, flips, interrupt);
            }
            ThirdStages third(*grid, voxels);
            third.guard();
            bad += requireAllFound(third.vertices, third.flips.flips(), third.interrupt);
        }
    }
    CHECK(bad > 1000);
    CHECK(lastResort > 0);
}

TEST_CASE("where the lattice resolves the shape there are next to no suspects") {
    for (const auto& grid : {levelSet(torus({0.3, 0.2, 0.1}, 20, 8)), levelSet(sphere({0.1, 0.2, 0.3}, 14)),
                             levelSet(box({-10.3, -9.2, -8.1}, {10.1, 9.4, 8.2}))}) {
        const Stages stages(*grid);
        Interrupt interrupt(nullptr);
        const Destinations destinations =
            findDestinations(stages.field, stages.layout, stages.cuts.arrows, stages.labels, interrupt);
        const Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
        CHECK(100 * count(findSuspects(vertices, interrupt)) < count(everyone(vertices)));
    }
}

} // namespace vdbtet::test
