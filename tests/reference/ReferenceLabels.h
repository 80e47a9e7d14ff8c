/// @file ReferenceLabels.h
/// Which vertices are manifold and where they move, by the paper's own search and by the definition of a
/// kernel.
#pragma once

#include "reference/DenseLattice.h"

namespace vdbtet::test {

struct Labels {
    static constexpr std::int8_t kNone = -1;

    /// The direction number of a manifold vertex's move; kNone for a vertex that is not manifold.
    std::vector<std::int8_t> move;
    /// Vertices that only a tie rule could settle: then the labelling is a matter of choice.
    std::int64_t undecided = 0;
    /// Manifold vertices with two candidates for the destination within 1e-6 of each other.
    std::int64_t destinationTies = 0;
    /// Manifold vertices that the search left with a destination other than the nearest.
    std::int64_t staleDestinations = 0;

    bool manifold(Vertex v) const { return move[v] != kNone; }
};

/// Algorithm 2, then Algorithm 3 with all of its first phase before its second. The destinations are then
/// chosen anew, as the search can leave one that was the nearest only while others were manifold.
Labels searchedLabels(const DenseLattice& lattice);

/// How far from an end, in short edges, a cut point may be for that end to be the near one.
struct Threshold {
    double tau = 0.5;               ///< from an end inside; 1 - tau from one outside
    std::vector<bool> flagged = {}; ///< the vertices at whose edges it is 1/2; empty for none

    double reach(const DenseLattice& lattice, Vertex v, int direction) const;
};

/// The kernel of the arrows from near to far ends of cut short edges: sinks join, their predecessors do not,
/// and so on; of the vertices that stay undecided those of L_A join.
Labels kernelLabels(const DenseLattice& lattice, const Threshold& threshold = {});

} // namespace vdbtet::test
