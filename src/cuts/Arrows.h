/// @file Arrows.h
/// The signs of the vertices, and the cut short edges, each as an arrow from the end nearer to its cut point
/// (paper, sections 2.3 and 4.1).
#pragma once

#include "Parallel.h"
#include "field/Field.h"
#include "tiles/Layout.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace vdbtet {

/// A vertex of a surface tile.
struct VertexRef {
    TileRef tile;
    bcc::Lattice lattice;
    int vertex; ///< its bit
};

/// @return the vertex at the other end of a short edge; its tile is kInside or kOutside where that is no
/// surface tile.
VertexRef farEnd(const Neighbours& neighbours, const VertexRef& v, int direction);

/// The vertices of a tile that an arrow leaves, by lattice and direction.
using TileArrows = std::array<EdgeMasks, 2>;

/// @brief Up to which fraction of a cut short edge, from the end inside, that end is the nearer one.
/// @details 1/2 in versions 1 and 2. Version 3 moves vertices outwards rather than inwards, but for those
/// that are flagged: at their edges it is 1/2, too.
struct Threshold {
    double tau = 0.5;
    const VertexMasks* flagged = nullptr; ///< null for none
};

/// @brief The arrows of all cut short edges; on a tie an arrow leaves the L_A end.
/// @details Labelling needs to know of a cut point only in which half of its edge it lies. Where exactly
/// matters to the one manifold vertex that may move there, so it is left to that vertex (see Destinations).
struct Arrows {
    std::vector<std::unique_ptr<const TileArrows>> of; ///< each surface tile; null where no edge is cut
    std::vector<TileRef> tiles;                        ///< those that are not null, ascending
    std::int64_t cutEdges = 0;
};

/// What the field has to say before labels are known.
struct Cuts {
    std::vector<TileSigns> signs; ///< of each surface tile; decided here, once: all later stages read them
    Arrows arrows;
    std::int64_t insideTets = 0; ///< of the uniform mesh, with inside vertices alone: these tiles'
};

/// @brief Find the signs and the arrows of @a tiles.
/// @param tau  of the threshold; no vertex is flagged
/// @param mostTets  ends early, with a part of all, once there are more inside tets than this
/// @details A tile's edges that end in its neighbours are decided by both: the same values, so the same bits.
Cuts findCuts(const Field& field, const std::vector<openvdb::Coord>& tiles, double tau, Interrupt& interrupt,
              std::int64_t mostTets = std::numeric_limits<std::int64_t>::max());

/// Find the arrows of some of the tiles again.
void turnArrows(const Field& field, const Layout& layout, const Threshold& threshold,
                const std::vector<TileRef>& tiles, Arrows& arrows, Interrupt& interrupt);

} // namespace vdbtet
