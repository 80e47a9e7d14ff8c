/// @file Labels.cc
/// Parallel rounds, the worklist and the tie rule (instead of the paper's Algorithms 2 and 3).
#include "labels/Labelling.h"

#include "bits/PaddedMask.h"

#include <algorithm>
#include <chrono>
#include <deque>

namespace vdbtet {

Labelling::Labelling(const Layout& layout, const Arrows& arrows, Interrupt& interrupt)
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

void Labelling::runPhase(bcc::Lattice lattice) {
    forTiles([&](TileRef t) { settleTile(t, lattice); });
}

/// Rule 1 for all vertices of one lattice of a tile.
void Labelling::settleTile(TileRef t, bcc::Lattice lattice) {
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

/// Rule 1 for one vertex.
/// @return true if it settled the vertex
bool Labelling::settle(const VertexRef& v, const Neighbours& neighbours) {
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

std::int64_t Labelling::findLeft() {
    std::int64_t count = 0;
    for (TileRef t : mArrows.tiles) {
        const int left = mUndecided[t][bcc::A].count() + mUndecided[t][bcc::B].count();
        if (left > 0) mLeft.push_back(t);
        count += left;
    }
    return count;
}

bool Labelling::runWorklist() {
    std::deque<VertexRef> work;
    for (TileRef t : mLeft) {
        for (bcc::Lattice lattice : {bcc::A, bcc::B})
            mUndecided[t][lattice].forEach([&](int vertex) { work.push_back({t, lattice, vertex}); });
    }
    bool any = false;
    while (!work.empty()) {
        const VertexRef v = work.front();
        work.pop_front();
        if (!undecided(v)) continue;
        const Neighbours& neighbours = mLayout.neighbours[v.tile];
        if (!settle(v, neighbours)) continue;
        any = true;
        for (int d = 0; d < bcc::kDirections; ++d) {
            const VertexRef from = farEnd(neighbours, v, d);
            if (from.tile < 0 || from.tile >= mLayout.ownCount() || !undecided(from)) continue;
            if (leaves(from, bcc::opposite(d))) work.push_back(from);
        }
    }
    return any;
}

std::int64_t Labelling::breakTies() {
    std::int64_t count = 0;
    for (TileRef t : mLeft) {
        count += mUndecided[t][bcc::A].count() + mUndecided[t][bcc::B].count();
        mManifold[t][bcc::B] |= mUndecided[t][bcc::B];
    }
    return count;
}

Labels labelVertices(const Layout& layout, const Arrows& arrows, Interrupt& interrupt, const Seams& seams) {
    Labelling labelling(layout, arrows, interrupt);
    const auto exchange = [&] {
        seams.exchange(
            [&](TileRef t, Bytes& bytes) {
                pack(bytes, labelling.undecided()[t]);
                pack(bytes, labelling.manifold()[t]);
            },
            [&](TileRef t, Unpacker& next) {
                next(&labelling.undecided()[t], 1);
                next(&labelling.manifold()[t], 1);
            });
    };
    exchange();
    for (int round = 0; round < Labelling::kRounds; ++round) {
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            labelling.runPhase(lattice);
            exchange();
        }
    }
    Labels labels;
    const auto start = std::chrono::steady_clock::now();
    if (!interrupt.stopped()) {
        labels.backLabelled = labelling.findLeft();
        // Wherever a chain of arrows leads from part to part, each turn follows it to the next seam.
        while (seams.any(labelling.runWorklist())) exchange();
        labels.tieBroken = labelling.breakTies();
        exchange();
        seams.sum(labels.backLabelled);
        seams.sum(labels.tieBroken);
        labels.backLabelled -= labels.tieBroken;
    }
    labels.worklistSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    labels.manifold = std::move(labelling.manifold());
    return labels;
}

} // namespace vdbtet
