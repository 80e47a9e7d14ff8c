/// @file TileMeasurer.h
/// Judges the tets of one tile after another (paper, section 4.5).
#pragma once

#include "quality/AngleSum.h"
#include "tets/TileTets.h"

#include <cstdint>

namespace vdbtet {

/// What tiles contribute to the report; sums of integers and extremes, so neither the order nor the thread
/// matters.
struct Measure {
    AngleSum angles;
    std::int64_t boundaryTriangles = 0;

    void add(Measure& other) {
        angles.add(other.angles);
        boundaryTriangles += other.boundaryTriangles;
    }
};

/// One for each thread.
class TileMeasurer {
public:
    explicit TileMeasurer(const Vertices& vertices) : mVertices(vertices) {}

    /// @param tets,states  of surface tile @a tile
    void measure(TileRef tile, const TileTets& tets, const LocalStates& states);

    Measure& sum() { return mSum; }

private:
    void addAngles(const TileTets& tets);

    const Vertices& mVertices;
    LocalPositions mPositions;
    Measure mSum;
};

} // namespace vdbtet
