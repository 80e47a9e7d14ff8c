/// @file Labels.cc
/// Parallel rounds, the worklist and the tie rule (instead of the paper's Algorithms 2 and 3).
#include "labels/Labels.h"

#include "bits/PaddedMask.h"

#include <algorithm>
#include <chrono>
#include <deque>

namespace vdbtet {

namespace {

using LatticeMasks = std::array<TileMask, 2>;

class Labelling {
public:
    Labelling(const Layout& layout, const Arrows& arrows, Interrupt& interrupt)
        : mLayout(layout), mArrows(arrows), mInterrupt(interrupt), mUndecided(layout.surfaceTiles.size()),
          mManifold(layout.surfaceTiles.size()) {
        mInterrupt.expectLoops(1 + 2 * kRounds);
        // A vertex without arrows is trivially in K. Then so is every vertex that is neither manifold nor
        // undecided.
        forTiles([&](TileRef t) {
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                for (const TileMask& mask : (*mArrows.of[t])[lattice]) mUndecided[t][lattice] |= mask;
            }
        });
    }

    Labels run() {
        // Each phase reads one lattice and writes the other.
        for (int round = 0; round < kRounds; ++round) {
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                forTiles([&](TileRef t) { settleTile(t, lattice); });
            }
        }
        Labels labels;
        const auto start = std::chrono::steady_clock::now();
        if (!mInterrupt.stopped()) {
            runWorklist(labels);
            breakTies(labels);
        }
        labels.worklistSeconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        labels.manifold = std::move(mManifold);
        return labels;
    }

private:
    /// Resolved surfaces settle in two or three rounds.
    static constexpr int kRounds = 3;

    /// Call @a body for all tiles with cut edges.
    template <typename Body>
    void forTiles(Body&& body) {
        parallelRanges(std::int64_t(mArrows.tiles.size()), mInterrupt,
                       [&](std::int64_t begin, std::int64_t end) {
                           for (std::int64_t i = begin; i < end; ++i) body(mArrows.tiles[i]);
                       });
    }

    /// Rule 1 for all vertices of one lattice of a tile.
    void settleTile(TileRef t, bcc::Lattice lattice) {
        TileMask& undecided = mUndecided[t][lattice];
        if (!undecided.any()) return;
        const EdgeMasks& leaving = (*mArrows.of[t])[lattice];
        const Surroundings around(mLayout.neighbours[t]);
        const PaddedMask farManifold(around.masks(mManifold, bcc::other(lattice)));
        const PaddedMask farUndecided(around.masks(mUndecided, bcc::other(lattice)));
        TileMask intoK, notIntoManifold;
        for (int d = 0; d < bcc::kDirections; ++d) {
            if (!leaving[d].any()) continue;
            const bcc::Step step = bcc::shortEdge(lattice, d);
            const TileMask toOther = leaving[d] & ~farManifold.shifted(step.x, step.y, step.z);
            intoK |= toOther & ~farUndecided.shifted(step.x, step.y, step.z);
            notIntoManifold |= toOther;
        }
        mManifold[t][lattice] |= undecided & intoK;
        undecided &= ~intoK & notIntoManifold;
    }

    bool leaves(const VertexRef& v, int direction) const {
        return (*mArrows.of[v.tile])[v.lattice][direction].test(v.vertex);
    }
    bool undecided(const VertexRef& v) const { return mUndecided[v.tile][v.lattice].test(v.vertex); }
    bool manifold(const VertexRef& v) const { return mManifold[v.tile][v.lattice].test(v.vertex); }

    /// Rule 1 for one vertex.
    /// @return true if it settled the vertex
    bool settle(const VertexRef& v, const Neighbours& neighbours) {
        bool allManifold = true;
        for (int d = 0; d < bcc::kDirections; ++d) {
            if (!leaves(v, d)) continue;
            const VertexRef end = farEnd(neighbours, v, d);
            if (manifold(end)) continue;
            allManifold = false;
            if (!undecided(end)) {
                mManifold[v.tile][v.lattice].set(v.vertex);
                mUndecided[v.tile][v.lattice].reset(v.vertex);
                return true;
            }
        }
        if (allManifold) mUndecided[v.tile][v.lattice].reset(v.vertex);
        return allManifold;
    }

    /// The paper's back-labelling: what is settled may settle those whose arrows lead to it.
    void runWorklist(Labels& labels) {
        std::deque<VertexRef> work;
        for (TileRef t : mArrows.tiles) {
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                if (!mUndecided[t][lattice].any()) continue;
                mUndecided[t][lattice].forEach([&](int vertex) { work.push_back({t, lattice, vertex}); });
                mLeft.push_back(t);
            }
        }
        labels.backLabelled = std::int64_t(work.size());
        while (!work.empty()) {
            const VertexRef v = work.front();
            work.pop_front();
            if (!undecided(v)) continue;
            const Neighbours& neighbours = mLayout.neighbours[v.tile];
            if (!settle(v, neighbours)) continue;
            for (int d = 0; d < bcc::kDirections; ++d) {
                const VertexRef from = farEnd(neighbours, v, d);
                if (from.tile < 0 || !undecided(from)) continue;
                if (leaves(from, bcc::opposite(d))) work.push_back(from);
            }
        }
    }

    /// Rule 2. Valid only after rule 1 has converged: each vertex left has an arrow to another one left.
    void breakTies(Labels& labels) {
        mLeft.erase(std::unique(mLeft.begin(), mLeft.end()), mLeft.end());
        for (TileRef t : mLeft) {
            labels.tieBroken += mUndecided[t][bcc::A].count() + mUndecided[t][bcc::B].count();
            mManifold[t][bcc::B] |= mUndecided[t][bcc::B];
        }
        labels.backLabelled -= labels.tieBroken;
    }

    const Layout& mLayout;
    const Arrows& mArrows;
    Interrupt& mInterrupt;
    std::vector<LatticeMasks> mUndecided;
    std::vector<LatticeMasks> mManifold;
    std::vector<TileRef> mLeft; ///< the tiles that the rounds left something undecided in
};

} // namespace

Labels labelVertices(const Layout& layout, const Arrows& arrows, Interrupt& interrupt) {
    return Labelling(layout, arrows, interrupt).run();
}

} // namespace vdbtet
