/// @file Guard.cc
/// Rounds over the tiles that changed.
#include "guard/Guard.h"

#include "guard/BadTets.h"

#include <algorithm>
#include <utility>

namespace vdbtet {

namespace {

class Guard {
public:
    Guard(const Field& field, double tau, const Vertices& vertices, const Guardable& products,
          Interrupt& interrupt, const Seams& seams)
        : mField(field), mVertices(vertices), mProducts(products), mInterrupt(interrupt), mSeams(seams) {
        mThreshold.tau = tau;
    }

    Guarded run() {
        const Layout& layout = mVertices.layout;
        Guarded guarded;
        guarded.flagged.resize(layout.surfaceTiles.size());
        mThreshold.flagged = &guarded.flagged;
        std::vector<TileRef> tiles(std::size_t(layout.ownCount()));
        for (std::size_t t = 0; t < tiles.size(); ++t) tiles[t] = TileRef(t);
        std::vector<char> hasBad(tiles.size());
        while (true) {
            VertexMasks changed(guarded.flagged.size());
            mSeams.together([&] {
                const Flips flips = mProducts.flips.flips();
                for (const VertexRef& v : verticesOfBadTets(mVertices, flips, tiles, hasBad, mInterrupt))
                    changed[v.tile][v.lattice].set(v.vertex);
            });
            mSeams.unite(changed);
            const std::int64_t added = flag(changed, guarded.flagged);
            if (added == 0 || mInterrupt.stopped()) {
                guarded.tilesWithBad = std::count(hasBad.begin(), hasBad.end(), 1);
                mSeams.sum(guarded.tilesWithBad);
                return guarded;
            }
            guarded.count += added;
            ++guarded.rounds;
            makeAnew(changed);
            if (mInterrupt.stopped()) return guarded;
            tiles = near(changed);
        }
    }

private:
    std::vector<TileRef> near(const VertexMasks& changed) const {
        return tilesNear(mVertices.layout, changed, mInterrupt);
    }

    /// @param bad  receives those of its vertices that were not flagged before
    /// @return how many these are, in all parts
    std::int64_t flag(VertexMasks& bad, VertexMasks& flagged) const {
        std::int64_t added = 0;
        for (std::size_t t = 0; t < bad.size(); ++t) {
            for (std::size_t l = 0; l < 2; ++l) {
                bad[t][l] &= ~flagged[t][l];
                flagged[t][l] |= bad[t][l];
                if (std::int64_t(t) < mVertices.layout.ownCount()) added += bad[t][l].count();
            }
        }
        mSeams.sum(added);
        return added;
    }

    /// @param changed  the vertices newly flagged; then also those that differ in label or destination, and
    /// the lower ends of spines that are flipped another way
    void makeAnew(VertexMasks& changed) {
        const Layout& layout = mVertices.layout;
        mSeams.together(
            [&] { turnArrows(mField, layout, mThreshold, near(changed), mProducts.arrows, mInterrupt); });
        if (mInterrupt.stopped()) return;
        Labels labels = labelVertices(layout, mProducts.arrows, mInterrupt, mSeams);
        if (mInterrupt.stopped()) return;
        const VertexMasks& before = mProducts.labels.manifold;
        for (std::size_t t = 0; t < before.size(); ++t) {
            for (std::size_t l = 0; l < 2; ++l) changed[t][l] |= before[t][l] ^ labels.manifold[t][l];
        }
        std::swap(mProducts.labels, labels); // labels has the old ones now
        const std::vector<TileRef> moved = near(changed);
        Destinations destinations;
        mSeams.together([&] {
            destinations = findGradientDestinations(mField, layout, mProducts.arrows, mProducts.labels,
                                                    mThreshold, &moved, &mProducts.destinations, mInterrupt);
        });
        if (mInterrupt.stopped()) return;
        destinations.exchange(mSeams);
        std::swap(mProducts.destinations, destinations);
        for (const TileRef t : moved) markMoved(t, labels, destinations, changed);
        for (std::int64_t t = layout.ownCount(); t < layout.surfaceCount(); ++t)
            markMoved(TileRef(t), labels, destinations, changed);
        mProducts.flips.choose(near(changed), changed, mInterrupt, mSeams);
    }

    /// Mark the vertices of a tile that are elsewhere than they were.
    void markMoved(TileRef t, const Labels& labels, const Destinations& before, VertexMasks& changed) const {
        const Destinations& now = mProducts.destinations;
        for (std::size_t l = 0; l < 2; ++l) {
            const TileMask &was = labels.manifold[t][l], &is = mProducts.labels.manifold[t][l];
            (was & is).forEach([&](int n) {
                if (before.offsets[std::size_t(before.first[t][l] + was.rank(n))] !=
                    now.offsets[std::size_t(now.first[t][l] + is.rank(n))])
                    changed[t][l].set(n);
            });
        }
    }

    const Field& mField;
    const Vertices& mVertices;
    const Guardable& mProducts;
    Interrupt& mInterrupt;
    const Seams& mSeams;
    Threshold mThreshold;
};

} // namespace

Guarded guardAngles(const Field& field, double tau, const Vertices& vertices, const Guardable& products,
                    Interrupt& interrupt, const Seams& seams) {
    return Guard(field, tau, vertices, products, interrupt, seams).run();
}

} // namespace vdbtet
