/// @file Destinations.h
/// Where the manifold vertices move to (paper, section 4.2 and step 5 of Algorithm 1).
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"
#include "tiles/Seams.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief The moves of the manifold vertices from their places in the lattice.
/// @details Later stages read nothing but move(); Algorithm 5 alone asks for directions and distances, too.
/// Those are of versions 1 and 2; version 3 has offsets in their place.
struct Destinations {
    std::vector<std::array<std::int64_t, 2>>
        first; ///< the first move of a tile and lattice, and the end; they go by bit of Labels::manifold
    std::vector<std::array<std::array<std::uint16_t, TileMask::kDim>, 2>>
        before;                   ///< how many of them there are before each word of that mask
    std::vector<float> distances; ///< as fractions of a short edge
    std::vector<std::uint8_t> directions;
    std::vector<openvdb::Vec3f> offsets; ///< lattice units

    /// Number the moves of the vertices in Labels::manifold.
    /// @return how many there are
    std::int64_t number(const VertexMasks& manifold);

    /// Call @a visit for each array that has an entry a move.
    template <typename Visit>
    void forEachArray(Visit&& visit) {
        if (!offsets.empty()) return visit(offsets);
        visit(distances);
        visit(directions);
    }

    /// Get the moves of borrowed tiles, whose labels are known.
    void exchange(const Seams& seams);

    /// @return whether a surface tile has any manifold vertex.
    bool any(TileRef tile) const { return first[tile][bcc::A] != first[tile + 1][bcc::A]; }

    /// @return move number @a i, in lattice units.
    openvdb::Vec3d move(std::int64_t i) const {
        if (!offsets.empty()) return openvdb::Vec3d(offsets[i]);
        const double distance = distances[i];
        const auto& edge = bcc::kShortEdges[directions[i]];
        return openvdb::Vec3d(distance * edge[0], distance * edge[1], distance * edge[2]);
    }
};

/// Each manifold vertex moves to its nearest cut point on an edge to a non-manifold vertex, at most half the
/// edge; of equally near ones the lowest direction wins.
Destinations findDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                              const Labels& labels, Interrupt& interrupt);

/// @brief The destinations of version 3.
/// @details Each manifold vertex that is not flagged moves along the gradient of the field, see
/// Field::Sampler::alongGradient(), but not farther than its cut point of above is away. Where the surface is
/// not met by then, and if it is flagged, it moves to that.
/// @param threshold  as for the arrows
/// @param redo       the own tiles to find destinations of, ascending; null for all
/// @param before     those of all other own tiles, whose labels are the same now; null with @a redo
Destinations findGradientDestinations(const Field& field, const Layout& layout, const Arrows& arrows,
                                      const Labels& labels, const Threshold& threshold,
                                      const std::vector<TileRef>* redo, const Destinations* before,
                                      Interrupt& interrupt);

} // namespace vdbtet
