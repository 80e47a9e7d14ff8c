/// @file Configuration.h
/// Labelled and moving vertices of the lattice: which of them the labelling allows, and which are alike.
#pragma once

#include "bcc/Lattice.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbtet::proof {

enum class Label { Inside, Outside, Manifold };

/// A vertex in doubled coordinates, which are all even in L_A and all odd in L_B.
struct Site {
    std::array<int, 3> at;
    Label label = Label::Inside;
    int direction = -1; ///< of the short edge along which a manifold vertex moves
};

using Configuration = std::vector<Site>;

/// A vertex of the lattice tables as a site.
Site siteOf(const bcc::Vertex& vertex);

/// The direction of the short edge between two sites, or parallel to it; -1 if there is none.
int directionBetween(const Site& from, const Site& to);

/// The sites in units of the spacing, with their labels and directions.
std::string describe(const Configuration& configuration);

/// @brief Whether the labelling can end so.
/// @details What it guarantees (labels/Labels.h): a manifold vertex moves along a cut edge to a vertex that
/// is not manifold, so of the other sign; and no cut short edge joins two vertices that are not manifold. So
/// signs must exist for the manifold vertices such that the known and the targets agree with both.
bool allowed(const Configuration& configuration);

/// @brief The same number for configurations that a symmetry of the lattice takes into each other, and no
/// others.
/// @details The symmetries are translations, and the 48 motions and reflections that map the axes onto each
/// other. The order of the sites does not matter. The key is made of the least image.
using Key = std::vector<std::uint32_t>;
Key keyOf(const Configuration& configuration);

} // namespace vdbtet::proof
