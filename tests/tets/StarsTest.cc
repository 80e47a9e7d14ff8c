// The star of a vertex has just the tets of the mesh that tiles list, and names them as tiles do.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include "destinations/Destinations.h"
#include "flips/Flips.h"
#include "repair/Repair.h"
#include "tets/Stars.h"
#include "tets/TileTets.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace vdbtet::test {

namespace {

using Vertex = std::array<int, 4>; ///< lattice, x, y, z
using Corners = std::array<Vertex, 4>;

Vertex vertexOf(const openvdb::Coord& tile, int local) {
    const int n = bitOf(local);
    return {latticeOf(local), 8 * tile.x() + PaddedMask::x(n), 8 * tile.y() + PaddedMask::y(n),
            8 * tile.z() + PaddedMask::z(n)};
}

template <typename Locals>
Corners cornersOf(const openvdb::Coord& tile, const Locals& local) {
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = vertexOf(tile, local(int(i)));
    std::sort(corners.begin(), corners.end());
    return corners;
}

/// @return how many tets are in the mesh
std::size_t requireStars(const Stages& stages, const Vertices& vertices, const Flips& flips) {
    const auto& tiles = stages.layout.surfaceTiles;
    std::map<Vertex, std::set<Corners>> expected;
    std::set<Corners> all;
    LocalStates states;
    TileTets tets(vertices, flips);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        states.load(vertices, TileRef(t));
        tets.load(TileRef(t), states);
        tets.change(vertices.changesOf(TileRef(t)));
        std::int64_t count = 0;
        tets.forEachCode([&](TetCode code) {
            const LocalTet tet = tets.tetOf(code);
            const Corners corners = cornersOf(tiles[t], [&](int i) { return tet.vertex(i); });
            CHECK(all.insert(corners).second);
            for (const Vertex& v : corners) expected[v].insert(corners);
            ++count;
        });
        CHECK(count == tets.tets());
    }

    Stars stars(vertices, flips);
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        states.load(vertices, TileRef(t));
        stars.load(TileRef(t), states);
        for (int lattice = 0; lattice < 2; ++lattice) {
            vertices.labels.manifold[t][lattice].forEach([&](int n) {
                const int v = localIndex(lattice, n);
                std::set<Corners> found;
                stars.forEachTet(v, [&](const StarTet& tet) {
                    if (tet.presence != Presence::InMesh) return;
                    found.insert(cornersOf(tiles[t], [&](int i) { return tet.vertices[std::size_t(i)]; }));
                });
                CHECK((found == expected[vertexOf(tiles[t], v)]));
            });
        }
    }
    return all.size();
}

} // namespace

TEST_CASE("stars have the tets of the mesh, before repair and after") {
    for (const auto& grid : {levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 12, 1.5)), randomSigns(20, 3)}) {
        const Stages stages(*grid, 1.0, 1);
        Interrupt interrupt(nullptr);
        const Destinations destinations =
            findDestinations(stages.field, stages.layout, stages.cuts.arrows, stages.labels, interrupt);
        Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
        const Flips flips = chooseFlips(vertices, 2, interrupt);
        const std::size_t before = requireStars(stages, vertices, flips);
        const Repair repair = repairBoundary(vertices, flips, Boundary::Manifold, interrupt);
        vertices.changes = &repair.changes;
        REQUIRE_FALSE(repair.changes.tiles.empty());
        const std::size_t after = requireStars(stages, vertices, flips);
        CHECK(std::int64_t(after) == std::int64_t(before) + repair.counts.filled - repair.counts.peeled);
    }
}

} // namespace vdbtet::test
