#include "labels/Labels.h"

#include <deque>

namespace vdbtet {

namespace {

using LatticeMasks = std::array<TileMask, 2>;

/// A vertex of a surface tile.
struct VertexRef {
    TileRef tile;
    bcc::Lattice lattice;
    int vertex;
};

class Labelling {
public:
    Labelling(const Layout& layout, const Cuts& cuts, Interrupt& interrupt)
        : mLayout(layout), mCuts(cuts), mInterrupt(interrupt), mUndecided(layout.surfaceTiles.size()),
          mManifold(layout.surfaceTiles.size()) {
        // A vertex without arrows is trivially in K. Then so is every vertex that is neither manifold nor
        // undecided.
        forTiles([&](TileRef t) {
            for (int lattice = 0; lattice < 2; ++lattice) {
                for (const TileMask& mask : mCuts.arrows[t][lattice]) mUndecided[t][lattice] |= mask;
            }
        });
    }

    Labels run() {
        // Resolved surfaces settle in two or three rounds. Each phase reads one lattice and writes the other.
        constexpr int kRounds = 3;
        for (int round = 0; round < kRounds; ++round) {
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                forTiles([&](TileRef t) { settleTile(t, lattice); });
            }
        }
        Labels labels;
        if (!mInterrupt.stopped()) {
            runWorklist(labels);
            breakTies(labels);
        }
        labels.manifold = std::move(mManifold);
        return labels;
    }

private:
    template <typename Body>
    void forTiles(Body&& body) {
        parallelRanges(std::int64_t(mUndecided.size()), mInterrupt,
                       [&](std::int64_t begin, std::int64_t end) {
                           for (std::int64_t t = begin; t < end; ++t) body(TileRef(t));
                       });
    }

    /// Rule 1 for all vertices of one lattice of a tile.
    void settleTile(TileRef t, bcc::Lattice lattice) {
        TileMask& undecided = mUndecided[t][lattice];
        if (!undecided.any()) return;
        const Surroundings around(mLayout.neighbours[t]);
        const PaddedMask farManifold = around.masks(mManifold, bcc::other(lattice));
        const PaddedMask farUndecided = around.masks(mUndecided, bcc::other(lattice));
        TileMask intoK, notIntoManifold;
        for (int d = 0; d < bcc::kDirections; ++d) {
            const TileMask& arrows = mCuts.arrows[t][lattice][d];
            if (!arrows.any()) continue;
            const bcc::Step step = bcc::shortEdge(lattice, d);
            const TileMask toOther = arrows & ~farManifold.shifted(step.x, step.y, step.z);
            intoK |= toOther & ~farUndecided.shifted(step.x, step.y, step.z);
            notIntoManifold |= toOther;
        }
        mManifold[t][lattice] |= undecided & intoK;
        undecided &= ~intoK & notIntoManifold;
    }

    /// The vertex at the other end of a cut edge; such a vertex always lies in a surface tile.
    VertexRef farEnd(const VertexRef& v, int direction) const {
        const bcc::Step step = bcc::shortEdge(v.lattice, direction);
        const int x = (v.vertex >> 6) + step.x, y = (v.vertex >> 3 & 7) + step.y, z = (v.vertex & 7) + step.z;
        const int slot = neighbourSlot(tileStep(x), tileStep(y), tileStep(z));
        return {mLayout.neighbours[v.tile][slot], bcc::other(v.lattice), TileMask::bit(x & 7, y & 7, z & 7)};
    }

    bool undecided(const VertexRef& v) const { return mUndecided[v.tile][v.lattice].test(v.vertex); }
    bool manifold(const VertexRef& v) const { return mManifold[v.tile][v.lattice].test(v.vertex); }

    /// Rule 1 for one vertex.
    /// @return true if it settled the vertex
    bool settle(const VertexRef& v) {
        bool allManifold = true;
        for (int d = 0; d < bcc::kDirections; ++d) {
            if (!mCuts.arrows[v.tile][v.lattice][d].test(v.vertex)) continue;
            const VertexRef end = farEnd(v, d);
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
        for (TileRef t = 0; t < TileRef(mUndecided.size()); ++t) {
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                mUndecided[t][lattice].forEach([&](int vertex) { work.push_back({t, lattice, vertex}); });
            }
        }
        labels.backLabelled = std::int64_t(work.size());
        while (!work.empty()) {
            const VertexRef v = work.front();
            work.pop_front();
            if (!undecided(v) || !settle(v)) continue;
            for (int d = 0; d < bcc::kDirections; ++d) {
                const VertexRef from = farEnd(v, d);
                if (from.tile < 0 || !undecided(from)) continue;
                if (mCuts.arrows[from.tile][from.lattice][bcc::opposite(d)].test(from.vertex))
                    work.push_back(from);
            }
        }
    }

    /// Rule 2. Valid only after rule 1 has converged: each vertex left has an arrow to another one left.
    void breakTies(Labels& labels) {
        for (size_t t = 0; t < mUndecided.size(); ++t) {
            labels.tieBroken += mUndecided[t][bcc::A].count() + mUndecided[t][bcc::B].count();
            mManifold[t][bcc::B] |= mUndecided[t][bcc::B];
        }
        labels.backLabelled -= labels.tieBroken;
    }

    const Layout& mLayout;
    const Cuts& mCuts;
    Interrupt& mInterrupt;
    std::vector<LatticeMasks> mUndecided;
    std::vector<LatticeMasks> mManifold;
};

} // namespace

Labels labelVertices(const Layout& layout, const Cuts& cuts, Interrupt& interrupt) {
    return Labelling(layout, cuts, interrupt).run();
}

} // namespace vdbtet
