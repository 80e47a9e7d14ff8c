/// @file Destinations.cc
/// The nearest cut point of each manifold vertex (paper, equation (6)).
#include "destinations/Destinations.h"

#include "bits/PaddedMask.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace vdbtet {

namespace {

/// Nearer by less than this fraction of an edge is a tie: rounding must not choose the direction.
constexpr float kTie = 1e-6f;

/// The nearest cut points of the vertices of one lattice of a tile.
class Nearest {
public:
    explicit Nearest(std::unique_ptr<Field::Sampler> sampler) : mSampler(std::move(sampler)) {}

    void find(const openvdb::Coord& tile, bcc::Lattice lattice, const EdgeMasks& edges) {
        std::size_t count = 0;
        for (const TileMask& mask : edges) count += std::size_t(mask.count());
        mEdges.resize(count);
        mCuts.resize(count);
        ShortEdge* edge = mEdges.data();
        for (int d = 0; d < bcc::kDirections; ++d) {
            edges[d].forEach([&](int n) {
                const int vertex = PaddedMask::bit(n);
                *edge++ = {std::uint16_t(vertex), std::uint16_t(d)};
                mDistance[vertex] = 2.0f;
            });
        }
        mSampler->cutPoints(tile, lattice, mEdges, mCuts.data());
        for (std::size_t i = 0; i < mEdges.size(); ++i) {
            float& distance = mDistance[mEdges[i].vertex];
            distance = std::min(distance, mCuts[i]);
        }
        // The first direction that is as near as the nearest: the last one that we come by.
        for (std::size_t i = mEdges.size(); i-- > 0;) {
            Choice& choice = mChoice[mEdges[i].vertex];
            const Choice other{mCuts[i], mEdges[i].direction};
            choice = mCuts[i] > mDistance[mEdges[i].vertex] + kTie ? choice : other;
        }
    }

    struct Choice {
        float distance;
        std::uint32_t direction;
    };
    /// Of a vertex with edges.
    const Choice& choice(int vertex) const { return mChoice[PaddedMask::bit(vertex)]; }

private:
    std::unique_ptr<Field::Sampler> mSampler;
    std::vector<ShortEdge> mEdges;
    std::vector<float> mCuts;                         ///< of mEdges
    std::array<float, PaddedMask::kSize> mDistance{}; ///< of vertices with edges, as the next
    std::array<Choice, PaddedMask::kSize> mChoice{};
};

} // namespace

void Destinations::numberMoves(const std::vector<std::array<TileMask, 2>>& manifold) {
    first.resize(manifold.size() + 1);
    before.resize(manifold.size());
    std::int64_t sum = 0;
    for (std::size_t t = 0; t < manifold.size(); ++t) {
        for (int lattice = 0; lattice < 2; ++lattice) {
            first[t][lattice] = sum;
            unsigned inLattice = 0;
            for (int w = 0; w < TileMask::kDim; ++w) {
                before[t][lattice][w] = std::uint16_t(inLattice);
                inLattice += unsigned(countBits(manifold[t][lattice].words[w]));
            }
            sum += inLattice;
        }
    }
    first[manifold.size()] = {sum, sum};
    distances.resize(sum);
    directions.resize(sum);
}

Destinations findDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                              const Labels& labels, Interrupt& interrupt) {
    Destinations destinations;
    destinations.numberMoves(labels.manifold);
    const auto& cutTiles = arrows.tiles; // no other holds a manifold vertex
    tbb::enumerable_thread_specific<Nearest> parts([&] { return Nearest(field.sampler()); });
    interrupt.expectLoops(1);
    parallelRanges(std::int64_t(cutTiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        Nearest& nearest = parts.local();
        for (std::int64_t i = begin; i < end; ++i) {
            const TileRef t = cutTiles[i];
            const Surroundings around(layout.neighbours[t]);
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const TileMask& manifold = labels.manifold[t][lattice];
                if (!manifold.any()) continue;
                const PaddedMask far(around.masks(labels.manifold, bcc::other(lattice)));
                const EdgeMasks& leaving = (*arrows.of[t])[lattice];
                EdgeMasks edges;
                for (int d = 0; d < bcc::kDirections; ++d) {
                    const bcc::Step step = bcc::shortEdge(lattice, d);
                    edges[d] = leaving[d] & manifold & ~far.shifted(step.x, step.y, step.z);
                }
                nearest.find(layout.surfaceTiles[t], lattice, edges);
                std::int64_t move = destinations.first[t][lattice];
                manifold.forEach([&](int vertex) {
                    destinations.distances[move] = nearest.choice(vertex).distance;
                    destinations.directions[move] = std::uint8_t(nearest.choice(vertex).direction);
                    ++move;
                });
            }
        }
    });
    return destinations;
}

} // namespace vdbtet
