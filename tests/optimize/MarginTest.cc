// With a margin, every point that optimisation may move belongs to a surface tile, and so do its tets.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include "destinations/LocalVertices.h"

#include <array>
#include <set>

using openvdb::Coord;

namespace vdbtet::test {

namespace {

/// A vertex anywhere.
using Vertex = std::array<int, 4>; ///< lattice, x, y, z

Coord tileOf(const Vertex& v) { return Coord(v[1] >> 3, v[2] >> 3, v[3] >> 3); }

std::set<Vertex> manifoldVertices(const Stages& stages) {
    std::set<Vertex> all;
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        const Coord& tile = stages.layout.surfaceTiles[t];
        for (int lattice = 0; lattice < 2; ++lattice) {
            stages.labels.manifold[t][lattice].forEach([&](int n) {
                all.insert(
                    {lattice, 8 * tile.x() + (n >> 6), 8 * tile.y() + (n >> 3 & 7), 8 * tile.z() + (n & 7)});
            });
        }
    }
    return all;
}

/// The vertices themselves, and those that a short or a long edge joins with one.
std::set<Vertex> withNeighbours(const std::set<Vertex>& vertices) {
    std::set<Vertex> all = vertices;
    for (const Vertex& v : vertices) {
        const auto lattice = bcc::Lattice(v[0]);
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(lattice, d);
            all.insert({bcc::other(lattice), v[1] + step.x, v[2] + step.y, v[3] + step.z});
        }
        for (int axis = 1; axis <= 3; ++axis) {
            for (const int step : {-1, 1}) {
                Vertex w = v;
                w[std::size_t(axis)] += step;
                all.insert(w);
            }
        }
    }
    return all;
}

void requireMargin(const openvdb::FloatGrid& grid, double voxels) {
    CAPTURE(voxels);
    const Stages stages(grid, voxels, 1);
    const auto& tiles = stages.layout.surfaceTiles;
    const std::set<Coord> known(tiles.begin(), tiles.end());
    const auto movable = withNeighbours(manifoldVertices(stages));
    REQUIRE(movable.size() > 100);
    for (const Vertex& v : movable) {
        REQUIRE(known.count(tileOf(v)) == 1);
        for (const bcc::Lattice spine : {bcc::A, bcc::B}) {
            for (int axis = 0; axis < 3; ++axis) {
                for (const bcc::Vertex& o : bcc::kOctahedra[spine][axis]) {
                    if (o.lattice != v[0]) continue;
                    // The octahedron that has v in the place of o.
                    REQUIRE(known.count(tileOf({spine, v[1] - o.x, v[2] - o.y, v[3] - o.z})) == 1);
                }
            }
        }
    }
}

} // namespace

TEST_CASE("a margin of a cell holds all that may move, and its tets", "[optimize]") {
    for (const double voxels : {0.7, 1.0, 1.9}) {
        requireMargin(*levelSet(sphere({0.1, 0.2, 0.3}, 11.3)), voxels);
        requireMargin(*levelSet(noiseBall(1, {3.1, 0.2, 0.3}, 12, 3)), voxels);
        requireMargin(*randomSigns(14, 3), voxels);
    }
    requireMargin(*levelSet(sphere({0.1, 0.2, 0.3}, 6.0), rotatedTransform(0.7)), 1.0);
    requireMargin(*constantTiles(8, {Coord(0, 0, 0), Coord(8, 8, 0)}, false), 1.0);
}

TEST_CASE("what is next to a vertex is found by masks", "[optimize]") {
    const Stages stages(*levelSet(noiseBall(1, {3.1, 0.2, 0.3}, 12, 3)));
    const auto manifold = manifoldVertices(stages);
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        const Coord& tile = stages.layout.surfaceTiles[t];
        const Surroundings around(stages.layout.neighbours[t]);
        const std::array<PaddedMask, 2> masks{PaddedMask(around.masks(stages.labels.manifold, bcc::A)),
                                              PaddedMask(around.masks(stages.labels.manifold, bcc::B))};
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            const TileMask found = nextTo(masks, lattice);
            for (int n = 0; n < TileMask::kSize; ++n) {
                const Vertex v{lattice, 8 * tile.x() + (n >> 6), 8 * tile.y() + (n >> 3 & 7),
                               8 * tile.z() + (n & 7)};
                auto near = withNeighbours({v});
                near.erase(v);
                bool expected = false;
                for (const Vertex& w : near) expected = expected || manifold.count(w) == 1;
                REQUIRE(found.test(n) == expected);
            }
        }
    }
}

} // namespace vdbtet::test
