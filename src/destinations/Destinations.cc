/// @file Destinations.cc
/// The nearest cut point of each manifold vertex (paper, equation (6)).
#include "destinations/Destinations.h"

#include "bits/PaddedMask.h"

namespace vdbtet {

namespace {

/// Nearer by less than this fraction of an edge is a tie: rounding must not choose the direction.
constexpr float kTie = 1e-6f;

/// The nearest cut points of the vertices of one lattice of a tile.
class Nearest {
public:
    void find(Field::Sampler& sampler, const openvdb::Coord& tile, bcc::Lattice lattice,
              const EdgeMasks& edges) {
        int count = 0;
        for (const TileMask& mask : edges) count += mask.count();
        mCuts.resize(count);
        sampler.cutPoints(tile, lattice, edges, mCuts.data());

        mDistance.fill(2.0f);
        forEachCut(edges, [&](int, int vertex, float distance) {
            if (distance < mDistance[vertex]) mDistance[vertex] = distance;
        });
        // The first direction, in ascending order, that is as near as the nearest.
        mDirection.fill(kNone);
        forEachCut(edges, [&](int direction, int vertex, float distance) {
            if (mDirection[vertex] != kNone || distance > mDistance[vertex] + kTie) return;
            mDirection[vertex] = std::uint8_t(direction);
            mDistance[vertex] = distance;
        });
    }

    float distance(int vertex) const { return mDistance[vertex]; }
    std::uint8_t direction(int vertex) const { return mDirection[vertex]; }

private:
    static constexpr std::uint8_t kNone = 255;

    template <typename Visit>
    void forEachCut(const EdgeMasks& edges, Visit&& visit) const {
        const float* cut = mCuts.data();
        for (int d = 0; d < bcc::kDirections; ++d) {
            edges[d].forEach([&](int vertex) { visit(d, vertex, *cut++); });
        }
    }

    std::vector<float> mCuts;
    std::array<float, TileMask::kSize> mDistance;
    std::array<std::uint8_t, TileMask::kSize> mDirection;
};

} // namespace

Destinations findDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                              const Labels& labels, Interrupt& interrupt) {
    const std::int64_t tiles = layout.surfaceCount();
    Destinations destinations;
    destinations.first.resize(tiles + 1);
    std::int64_t sum = 0;
    for (std::int64_t t = 0; t < tiles; ++t) {
        for (int lattice = 0; lattice < 2; ++lattice) {
            destinations.first[t][lattice] = sum;
            sum += labels.manifold[t][lattice].count();
        }
    }
    destinations.first[tiles] = {sum, sum};
    destinations.distances.resize(sum);
    destinations.directions.resize(sum);

    const auto& cutTiles = arrows.tiles; // no other holds a manifold vertex
    parallelRanges(std::int64_t(cutTiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        const auto sampler = field.sampler();
        Nearest nearest;
        for (std::int64_t i = begin; i < end; ++i) {
            const TileRef t = cutTiles[i];
            const Surroundings around(layout.neighbours[t]);
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const TileMask& manifold = labels.manifold[t][lattice];
                if (!manifold.any()) continue;
                const PaddedMask far(around.masks(labels.manifold, bcc::other(lattice)));
                EdgeMasks edges = (*arrows.of[t])[lattice];
                for (int d = 0; d < bcc::kDirections; ++d) {
                    const bcc::Step step = bcc::shortEdge(lattice, d);
                    edges[d] &= manifold & ~far.shifted(step.x, step.y, step.z);
                }
                nearest.find(*sampler, layout.surfaceTiles[t], lattice, edges);
                std::int64_t move = destinations.first[t][lattice];
                manifold.forEach([&](int vertex) {
                    destinations.distances[move] = nearest.distance(vertex);
                    destinations.directions[move] = nearest.direction(vertex);
                    ++move;
                });
            }
        }
    });
    return destinations;
}

} // namespace vdbtet
