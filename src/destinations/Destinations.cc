#include "destinations/Destinations.h"

#include <algorithm>

namespace vdbtet {

namespace {

/// Nearer by less than this is a tie: rounding must not choose the direction.
constexpr float kTie = 1e-6f;

/// @return the fraction of the short edge from @a vertex of @a lattice to the cut point in @a direction.
float distanceToCut(const Layout& layout, const Cuts& cuts, TileRef tile, bcc::Lattice lattice, int vertex,
                    int direction) {
    if (lattice == bcc::A) return cuts.t(tile, vertex, direction);
    const bcc::Step step = bcc::shortEdge(bcc::B, direction);
    const int x = (vertex >> 6) + step.x, y = (vertex >> 3 & 7) + step.y, z = (vertex & 7) + step.z;
    const TileRef owner = layout.neighbours[tile][neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    return 1.0f - cuts.t(owner, TileMask::bit(x & 7, y & 7, z & 7), bcc::opposite(direction));
}

} // namespace

Destinations findDestinations(const Layout& layout, const Cuts& cuts, const Labels& labels,
                              Interrupt& interrupt) {
    const std::int64_t tiles = std::int64_t(layout.surfaceTiles.size());
    Destinations destinations;
    destinations.first.resize(tiles);
    std::int64_t sum = 0;
    for (std::int64_t t = 0; t < tiles; ++t) {
        for (int lattice = 0; lattice < 2; ++lattice) {
            destinations.first[t][lattice] = sum;
            sum += labels.manifold[t][lattice].count();
        }
    }
    destinations.moves.resize(sum);

    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const Surroundings around(layout.neighbours[t]);
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const TileMask& manifold = labels.manifold[t][lattice];
                if (!manifold.any()) continue;
                const PaddedMask far = around.masks(labels.manifold, bcc::other(lattice));
                EdgeMasks allowed;
                for (int d = 0; d < bcc::kDirections; ++d) {
                    const bcc::Step step = bcc::shortEdge(lattice, d);
                    allowed[d] = cuts.arrows[t][lattice][d] & ~far.shifted(step.x, step.y, step.z);
                }
                openvdb::Vec3f* move = destinations.moves.data() + destinations.first[t][lattice];
                manifold.forEach([&](int vertex) {
                    float distance[bcc::kDirections];
                    float nearest = 2.0f;
                    for (int d = 0; d < bcc::kDirections; ++d) {
                        distance[d] = allowed[d].test(vertex)
                                          ? distanceToCut(layout, cuts, TileRef(t), lattice, vertex, d)
                                          : 2.0f;
                        nearest = std::min(nearest, distance[d]);
                    }
                    int d = 0;
                    while (distance[d] > nearest + kTie) ++d;
                    const float half = 0.5f * distance[d];
                    *move++ = openvdb::Vec3f(bcc::sign(d, 0) * half, bcc::sign(d, 1) * half,
                                             bcc::sign(d, 2) * half);
                });
            }
        }
    });
    return destinations;
}

} // namespace vdbtet
