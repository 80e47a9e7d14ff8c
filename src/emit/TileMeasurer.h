/// @file TileMeasurer.h
/// Judges the tets of one tile after another (paper, section 4.5).
#pragma once

#include "quality/AngleSum.h"
#include "tets/TileTets.h"

namespace vdbtet {

/// One for each thread.
class TileMeasurer {
public:
    explicit TileMeasurer(const Vertices& vertices) : mVertices(vertices) {}

    /// @param tets  of surface tile @a tile
    void measure(TileRef tile, const TileTets& tets);

    /// Of the tile measured last.
    const LocalPositions& positions() const { return mPositions; }

    /// Sums of integers and extremes, so neither the order nor the thread matters.
    AngleSum& sum() { return mSum; }

private:
    void addAngles(const TileTets& tets);
    /// Where the octahedron of the L_A spine along @a axis has a vertex of number @a vertex that is not at
    /// home.
    TileMask moved(const TileTets& tets, int axis, int vertex) const;

    const Vertices& mVertices;
    LocalPositions mPositions;
    std::array<PaddedMask, 2> mMoved; ///< by lattice; where Vertices has Moves
    AngleSum mSum;
};

} // namespace vdbtet
