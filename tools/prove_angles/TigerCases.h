/// @file TigerCases.h
/// All configurations of the paper's method, made from the tables of the lattice.
#pragma once

#include "Configuration.h"

namespace vdbtet::proof {

/// A configuration and how many of those that were enumerated are like it.
struct Counted {
    Configuration configuration;
    int count;
};

/// @brief The tets of slice S that can be in the mesh, with at least one manifold vertex; those alike once.
/// @details The corners are in the order of bcc::kSliceTets.
std::vector<Counted> movedTets();

/// @brief The octahedra whose spine joins a vertex inside and one outside; those alike once.
/// @details The sites are in the order of bcc::kOctahedra. Their rings are manifold (Proposition 4).
std::vector<Counted> activeOctahedra();

/// One of Algorithm 5's configurations (Figure 10): v2, v3 and v4 move so that the tet of v1 to v4 is the
/// worst of all; the others are inside.
struct Figure {
    Configuration octahedron;  ///< in the order of bcc::kOctahedra
    std::array<int, 6> number; ///< of v1 to v6 in that order
    bcc::Slice slice;          ///< whose new edge ends where v2 moves away from

    const Site& v(int n) const { return octahedron[number[n - 1]]; }
    Configuration worstTet() const;
};

/// At all spines and both of their ends, and in all mirror images; none is left out for being like another.
std::vector<Figure> figures();

} // namespace vdbtet::proof
