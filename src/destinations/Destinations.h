/// @file Destinations.h
/// Where the manifold vertices move to (paper, section 4.2 and step 5 of Algorithm 1).
#pragma once

#include "Parallel.h"
#include "cuts/Cuts.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief The moves of the manifold vertices, in lattice units, from their places in the lattice.
/// @details A move along a short edge by the fraction alpha is (+-1, +-1, +-1) alpha / 2. Later stages read
/// nothing but the vector.
struct Destinations {
    std::vector<std::array<std::int64_t, 2>>
        first; ///< into moves, by tile and lattice; then by bit of Labels::manifold
    std::vector<openvdb::Vec3f> moves;
};

/// Each manifold vertex moves to its nearest cut point on an edge to a non-manifold vertex; of equally near
/// ones the lowest direction wins.
Destinations findDestinations(const Layout& layout, const Cuts& cuts, const Labels& labels,
                              Interrupt& interrupt);

} // namespace vdbtet
