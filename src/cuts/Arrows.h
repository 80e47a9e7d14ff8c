/// @file Arrows.h
/// The signs of the vertices, and the cut short edges, each as an arrow from the end nearer to its cut point
/// (paper, sections 2.3 and 4.1).
#pragma once

#include "Parallel.h"
#include "field/Field.h"
#include "tiles/Layout.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @return the signs of @a tiles. They are decided here, once; all later stages read these bits.
std::vector<TileSigns> findSigns(const Field& field, const std::vector<openvdb::Coord>& tiles,
                                 Interrupt& interrupt);

/// A vertex of a surface tile.
struct VertexRef {
    TileRef tile;
    bcc::Lattice lattice;
    int vertex; ///< its bit
};

/// @return the vertex at the other end of a short edge; its tile is kInside or kOutside where that is no
/// surface tile.
VertexRef farEnd(const Neighbours& neighbours, const VertexRef& v, int direction);

/// @brief The arrows of all cut short edges; on a tie an arrow leaves the L_A end.
/// @details Labelling needs to know of a cut point only in which half of its edge it lies. Where exactly
/// matters to the one manifold vertex that may move there, so it is left to that vertex (see Destinations).
class Arrows {
public:
    Arrows(const Field& field, const Layout& layout, const std::vector<TileSigns>& signs,
           Interrupt& interrupt);

    /// @return for each direction the vertices of @a lattice in a surface tile that an arrow leaves that way.
    EdgeMasks leaving(TileRef tile, const Neighbours& neighbours, bcc::Lattice lattice) const;

    std::int64_t cutEdges() const { return mCutEdges; }

private:
    const std::vector<TileSigns>& mSigns;
    /// For each vertex with a cut edge the set of directions in which an arrow leaves it; by tile, lattice
    /// and bit.
    std::vector<std::uint8_t> mLeaving;
    std::vector<std::array<std::int64_t, 2>> mFirst; ///< of each surface tile and lattice, in mLeaving
    std::int64_t mCutEdges = 0;
};

} // namespace vdbtet
