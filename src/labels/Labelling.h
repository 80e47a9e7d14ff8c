/// @file Labelling.h
/// The labelling step by step, for a whole mesh, or for a part of one between two talks with the others.
#pragma once

#include "labels/Labels.h"

namespace vdbtet {

/// @brief The masks, and what settles more and more of them; see Labels for the rules.
/// @details In a part of a mesh the borrowed tiles' masks are whoever's they are to keep up to date.
class Labelling {
public:
    Labelling(const Layout& layout, const Arrows& arrows, Interrupt& interrupt);

    /// Resolved surfaces settle in two or three rounds, of a phase for either lattice.
    static constexpr int kRounds = 3;

    /// Rule 1 for all vertices of one lattice: reads the other lattice, and writes this one.
    void runPhase(bcc::Lattice lattice);

    /// @return how many vertices are left to the worklist. Once, after the rounds.
    std::int64_t findLeft();
    /// @brief The paper's back-labelling: what is settled may settle those whose arrows lead to it.
    /// @return whether it settled any vertex
    bool runWorklist();
    /// @brief Rule 2. Valid only after rule 1 has converged: each vertex left has an arrow to another one
    /// left.
    /// @return how many vertices it settled
    std::int64_t breakTies();

    VertexMasks& undecided() { return mUndecided; }
    VertexMasks& manifold() { return mManifold; }

private:
    /// Call @a body for all tiles with cut edges.
    template <typename Body>
    void forTiles(Body&& body) {
        parallelRanges(std::int64_t(mArrows.tiles.size()), mInterrupt,
                       [&](std::int64_t begin, std::int64_t end) {
                           for (std::int64_t i = begin; i < end; ++i) body(mArrows.tiles[i]);
                       });
    }

    void settleTile(TileRef t, bcc::Lattice lattice);
    bool settle(const VertexRef& v, const Neighbours& neighbours);

    bool leaves(const VertexRef& v, int direction) const {
        return (*mArrows.of[v.tile])[v.lattice][direction].test(v.vertex);
    }
    bool undecided(const VertexRef& v) const { return mUndecided[v.tile][v.lattice].test(v.vertex); }
    bool manifold(const VertexRef& v) const { return mManifold[v.tile][v.lattice].test(v.vertex); }

    const Layout& mLayout;
    const Arrows& mArrows;
    Interrupt& mInterrupt;
    VertexMasks mUndecided, mManifold;
    std::vector<TileRef> mLeft; ///< the tiles that the rounds left something undecided in
};

} // namespace vdbtet
