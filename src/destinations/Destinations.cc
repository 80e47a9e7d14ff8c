/// @file Destinations.cc
/// The nearest cut point of each manifold vertex (paper, equation (6)), and the way along the gradient.
#include "destinations/Destinations.h"

#include "bits/PaddedMask.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

namespace vdbtet {

namespace {

/// Nearer by less than this fraction of an edge is a tie: rounding must not choose the direction.
constexpr float kTie = 1e-6f;

/// The nearest cut points of the vertices of one lattice of a tile.
class Nearest {
public:
    explicit Nearest(std::unique_ptr<Field::Sampler> sampler) : mSampler(std::move(sampler)) {}

    /// @param flagged  in and around the tile, by lattice
    void find(const openvdb::Coord& tile, bcc::Lattice lattice, const EdgeMasks& edges, double tau,
              const std::array<PaddedMask, 2>& flagged = std::array<PaddedMask, 2>()) {
        std::size_t count = 0;
        for (const TileMask& mask : edges) count += std::size_t(mask.count());
        mEdges.resize(count);
        mCuts.resize(count);
        const bool anyFlagged = flagged[bcc::A].any() || flagged[bcc::B].any();
        ShortEdge* edge = mEdges.data();
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(lattice, d);
            const int toEnd = PaddedMask::step(step.x, step.y, step.z);
            edges[d].forEach([&](int n) {
                const int vertex = PaddedMask::bit(n);
                const bool halved = anyFlagged && (flagged[lattice].test(vertex) ||
                                                   flagged[bcc::other(lattice)].test(vertex + toEnd));
                *edge++ = {std::uint16_t(vertex), std::uint8_t(d), halved};
                mChoice[vertex].distance = 2.0f;
            });
        }
        mSampler->cutPoints(tile, lattice, mEdges, tau, mCuts.data());
        // Of directions that are tied the first.
        for (std::size_t i = 0; i < mEdges.size(); ++i) {
            Choice& choice = mChoice[mEdges[i].vertex];
            const Choice other{mCuts[i], mEdges[i].direction};
            choice = other.distance < choice.distance - kTie ? other : choice;
        }
    }

    struct Choice {
        float distance;
        std::uint32_t direction;

        openvdb::Vec3d offset() const {
            return double(distance) * openvdb::Vec3d(bcc::kShortEdges[direction]);
        }
    };
    /// Of a vertex with edges.
    const Choice& choice(int vertex) const { return mChoice[PaddedMask::bit(vertex)]; }

    /// Find the destinations of the manifold vertices after find(), where they are not flagged along the
    /// gradient.
    /// @param offsets  receives them in the order of their bits
    void turnToGradient(const openvdb::Coord& tile, bcc::Lattice lattice, const TileMask& manifold,
                        const PaddedMask& flagged, openvdb::Vec3f* offsets) {
        const double kShortEdge = std::sqrt(0.75);
        mFree.clear();
        mReach.clear();
        manifold.forEach([&](int n) {
            const int vertex = PaddedMask::bit(n);
            if (flagged.test(vertex)) return;
            mFree.push_back(std::uint16_t(vertex));
            mReach.push_back(double(choice(n).distance) * kShortEdge);
        });
        mWays.resize(mFree.size());
        mSampler->alongGradient(tile, lattice, mFree, mReach, mWays.data());
        std::size_t next = 0;
        manifold.forEach([&](int n) {
            const bool isFree = next < mFree.size() && mFree[next] == PaddedMask::bit(n);
            const bool met = isFree && mWays[next] != openvdb::Vec3d(0.0);
            *offsets++ = openvdb::Vec3f(met ? mWays[next] : choice(n).offset());
            next += isFree;
        });
    }

private:
    std::unique_ptr<Field::Sampler> mSampler;
    std::vector<ShortEdge> mEdges;
    std::vector<float> mCuts;                        ///< of mEdges
    std::array<Choice, PaddedMask::kSize> mChoice{}; ///< of vertices with edges

    std::vector<std::uint16_t> mFree; ///< the vertices that are not flagged
    std::vector<double> mReach;       ///< of mFree, as the next
    std::vector<openvdb::Vec3d> mWays;
};

/// @return the edges from the manifold vertices of a tile and lattice to vertices that are not.
EdgeMasks edgesToKernel(const Surroundings& around, const Arrows& arrows, const Labels& labels, TileRef tile,
                        bcc::Lattice lattice) {
    const PaddedMask far(around.masks(labels.manifold, bcc::other(lattice)));
    EdgeMasks edges;
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(lattice, d);
        edges[d] = (*arrows.of[tile])[lattice][d] & labels.manifold[tile][lattice] &
                   ~far.shifted(step.x, step.y, step.z);
    }
    return edges;
}

} // namespace

std::int64_t Destinations::number(const VertexMasks& manifold) {
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
    return sum;
}

void Destinations::exchange(const Seams& seams) {
    // The moves of a tile lie side by side, of one lattice, then of the other.
    const auto forEach = [&](TileRef t, const auto& visit) {
        const std::int64_t begin = first[t][bcc::A], end = first[t + 1][bcc::A];
        forEachArray([&](auto& array) { visit(array.data() + begin, std::size_t(end - begin)); });
    };
    seams.exchange(
        [&](TileRef t, Bytes& bytes) {
            forEach(t, [&](const auto* moves, std::size_t count) { pack(bytes, moves, count); });
        },
        [&](TileRef t, Unpacker& next) {
            forEach(t, [&](auto* moves, std::size_t count) { next(moves, count); });
        });
}

Destinations findDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                              const Labels& labels, Interrupt& interrupt) {
    Destinations destinations;
    const std::int64_t moves = destinations.number(labels.manifold);
    destinations.distances.resize(moves);
    destinations.directions.resize(moves);
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
                const EdgeMasks edges = edgesToKernel(around, arrows, labels, t, lattice);
                nearest.find(layout.surfaceTiles[t], lattice, edges, 0.5);
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

Destinations findGradientDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                                      const Labels& labels, const Threshold& threshold,
                                      const std::vector<TileRef>* redo, const Destinations* before,
                                      Interrupt& interrupt) {
    Destinations destinations;
    destinations.offsets.resize(destinations.number(labels.manifold));
    if (before) {
        std::vector<bool> isRedone(layout.ownCount());
        for (const TileRef t : *redo) isRedone[t] = true;
        for (std::size_t t = 0; t < isRedone.size(); ++t) {
            if (isRedone[t]) continue;
            std::copy(before->offsets.begin() + before->first[t][bcc::A],
                      before->offsets.begin() + before->first[t + 1][bcc::A],
                      destinations.offsets.begin() + destinations.first[t][bcc::A]);
        }
    }
    const std::vector<TileRef>& tiles = redo ? *redo : arrows.tiles;
    tbb::enumerable_thread_specific<Nearest> parts([&] { return Nearest(field.sampler()); });
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        Nearest& nearest = parts.local();
        for (std::int64_t i = begin; i < end; ++i) {
            const TileRef t = tiles[i];
            if (!destinations.any(t)) continue;
            const Surroundings around(layout.neighbours[t]);
            std::array<PaddedMask, 2> flagged;
            if (threshold.flagged) {
                for (const bcc::Lattice lattice : {bcc::A, bcc::B})
                    flagged[lattice] = PaddedMask(around.masks(*threshold.flagged, lattice));
            }
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const TileMask& manifold = labels.manifold[t][lattice];
                if (!manifold.any()) continue;
                nearest.find(layout.surfaceTiles[t], lattice,
                             edgesToKernel(around, arrows, labels, t, lattice), threshold.tau, flagged);
                nearest.turnToGradient(layout.surfaceTiles[t], lattice, manifold, flagged[lattice],
                                       destinations.offsets.data() + destinations.first[t][lattice]);
            }
        }
    });
    return destinations;
}

} // namespace vdbtet
