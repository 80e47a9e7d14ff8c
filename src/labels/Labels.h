/// @file Labels.h
/// Which vertices are manifold: they move onto the surface (paper, sections 4.2 and 4.3).
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "tiles/Layout.h"
#include "tiles/Seams.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief The labelling, as the kernel of the digraph of arrows.
/// @details The paper's Algorithms 2 and 3 search for non-manifold vertices K such that every cut short edge
/// has a manifold end, and every manifold vertex has an arrow to a vertex of K. In terms of the arrows (see
/// Cuts) that is a kernel of a bipartite digraph, found by
///  1. a vertex with an arrow into K is manifold; a vertex all of whose arrows go to manifold vertices joins
///  K;
///  2. what 1 leaves, on exact ties and directed cycles only: L_A joins K, L_B is manifold, all at once.
/// Both are monotone and confluent, so the result does not depend on order, threads or tiles.
struct Labels {
    std::vector<std::array<TileMask, 2>> manifold; ///< of each surface tile, by lattice

    std::int64_t backLabelled = 0; ///< vertices left to the serial worklist
    std::int64_t tieBroken = 0;    ///< vertices settled by rule 2
    double worklistSeconds = 0.0;  ///< the serial part of the time
};

/// Label the vertices of own tiles, and get the labels of borrowed ones; counts are those of all parts.
Labels labelVertices(const Layout& layout, const Arrows& arrows, Interrupt& interrupt,
                     const Seams& seams = Seams());

} // namespace vdbtet
