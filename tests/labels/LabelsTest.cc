/// The labelling is the kernel of the arrows, whatever order finds it.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

namespace vdbtet::test {

namespace {

enum class Label { Undecided, Manifold, Kernel };

/// The arrows as a plain graph; vertices by lattice and integer coordinates.
struct Graph {
    using Key = std::tuple<int, int, int, int>;
    std::map<Key, std::vector<Key>> to;
    int edges = 0;

    explicit Graph(const Stages& stages) {
        for (TileRef t : stages.cuts.arrows.tiles) {
            const auto& tile = stages.layout.surfaceTiles[t];
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const EdgeMasks& leaving = (*stages.cuts.arrows.of[t])[lattice];
                for (int d = 0; d < bcc::kDirections; ++d) {
                    const bcc::Step step = bcc::shortEdge(lattice, d);
                    leaving[d].forEach([&](int n) {
                        const int x = 8 * tile.x() + (n >> 6), y = 8 * tile.y() + (n >> 3 & 7),
                                  z = 8 * tile.z() + (n & 7);
                        const Key end{bcc::other(lattice), x + step.x, y + step.y, z + step.z};
                        to[Key{lattice, x, y, z}].push_back(end);
                        to[end];
                        ++edges;
                    });
                }
            }
        }
    }

    /// Rule 1 vertex by vertex in the given order, until nothing changes, then rule 2.
    std::map<Key, Label> kernel(std::vector<Key> order, int& tieBroken) const {
        std::map<Key, Label> labels;
        for (const Key& v : order) labels[v] = Label::Undecided;
        for (bool changed = true; changed;) {
            changed = false;
            for (const Key& v : order) {
                if (labels[v] != Label::Undecided) continue;
                bool allManifold = true, intoKernel = false;
                for (const Key& end : to.at(v)) {
                    allManifold = allManifold && labels[end] == Label::Manifold;
                    intoKernel = intoKernel || labels[end] == Label::Kernel;
                }
                if (!allManifold && !intoKernel) continue;
                labels[v] = intoKernel ? Label::Manifold : Label::Kernel;
                changed = true;
            }
        }
        tieBroken = 0;
        for (auto& entry : labels) {
            if (entry.second != Label::Undecided) continue;
            ++tieBroken;
            entry.second = std::get<0>(entry.first) == bcc::A ? Label::Kernel : Label::Manifold;
        }
        return labels;
    }
};

bool isManifold(const Stages& stages, const Graph::Key& v) {
    const auto [lattice, x, y, z] = v;
    const openvdb::Coord tile(x >> 3, y >> 3, z >> 3);
    const auto& tiles = stages.layout.surfaceTiles;
    const auto found = std::lower_bound(tiles.begin(), tiles.end(), tile);
    REQUIRE((found != tiles.end() && *found == tile));
    return stages.labels.manifold[found - tiles.begin()][lattice].test(TileMask::bit(x & 7, y & 7, z & 7));
}

void requireKernel(const openvdb::FloatGrid& grid, double voxels, std::uint64_t seed) {
    const Stages stages(grid, voxels);
    const Graph graph(stages);
    REQUIRE(graph.edges > 0);
    REQUIRE(graph.edges == stages.cuts.arrows.cutEdges);

    std::vector<Graph::Key> order;
    for (const auto& entry : graph.to) order.push_back(entry.first);
    Random random(seed);
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
    int tieBroken = 0;
    const auto expected = graph.kernel(order, tieBroken);
    std::int64_t manifold = 0, counted = 0;
    for (const auto& entry : expected) {
        const bool is = isManifold(stages, entry.first);
        manifold += is;
        if (is != (entry.second == Label::Manifold)) FAIL("the labels differ from the kernel's");
    }
    for (const auto& masks : stages.labels.manifold) counted += masks[0].count() + masks[1].count();
    REQUIRE(counted == manifold);
    REQUIRE(stages.labels.tieBroken == tieBroken);

    // What the paper asks of a labelling, straight from the definition.
    for (const auto& entry : graph.to) {
        bool intoKernel = false;
        for (const auto& end : entry.second) {
            REQUIRE((isManifold(stages, entry.first) || isManifold(stages, end)));
            intoKernel = intoKernel || !isManifold(stages, end);
        }
        if (isManifold(stages, entry.first)) REQUIRE(intoKernel);
    }
}

} // namespace

TEST_CASE("the labels are the kernel of the arrows", "[labels]") {
    const std::uint64_t seed = GENERATE(1, 2, 3);
    SECTION("of a ball") {
        requireKernel(*levelSet(sphere(Vec3d(0.1 * double(seed), 0.2, 0.3), 11.0)), 1.0, seed);
    }
    SECTION("of noise") { requireKernel(*levelSet(noiseBall(seed, Vec3d(0.0), 12.0, 3.0)), 1.0, seed); }
    SECTION("of random cuts") { requireKernel(*randomCuts(8, seed), 2.0, seed); }
}

TEST_CASE("chains that the parallel rounds leave are settled by the worklist", "[labels]") {
    const auto grid = randomCuts(12, 11);
    const Stages stages(*grid, 2.0);
    REQUIRE(stages.labels.backLabelled > 0);
    requireKernel(*grid, 2.0, 4);
}

TEST_CASE("exact ties everywhere still make a valid labelling", "[labels]") {
    // Values of +1 and -1 alternate, so every cut is in the middle or at a vertex.
    auto grid = openvdb::FloatGrid::create(1.0f);
    for (int x = 0; x < 6; ++x) {
        for (int y = 0; y < 6; ++y) {
            for (int z = 0; z < 6; ++z) {
                grid->tree().setValue(openvdb::Coord(x, y, z), (x + y + z) % 2 == 0 ? -1.0f : 1.0f);
            }
        }
    }
    requireKernel(*grid, 1.0, 5);
    requireKernel(*grid, 0.5, 6);
}

} // namespace vdbtet::test
