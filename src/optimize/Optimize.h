/// @file Optimize.h
/// Better tets at the surface, by moving points: those inside freely, those on the surface along it.
#pragma once

#include "Parallel.h"
#include "destinations/LocalVertices.h"
#include "destinations/Moves.h"
#include "field/Field.h"
#include "flips/Flips.h"
#include "tiles/Seams.h"

#include <vdbtet/Quality.h>

#include <cstdint>

namespace vdbtet {

struct OptimizeOptions {
    double target;    ///< the least dihedral angle to reach, degrees
    int sweeps;       ///< at most
    double tolerance; ///< how far a point may be off the zero set, lattice units
};

struct Optimized {
    Moves moves;
    AngleRange before;              ///< of the part's tets at manifold vertices
    std::int64_t verticesMoved = 0; ///< in all parts
    int sweeps = 0;
};

/// @brief Move points until no tet is worse than the target, or no move helps.
/// @param vertices  where they are at their destinations; the tiles having a margin of 1, see
/// Field::surfaceTiles()
/// @details Each move makes the worst tet of its vertex better, and keeps the angles there in [25, 140]
/// degrees, or where they were beyond. The connectivity stays. Tiles take turns by the parity of their
/// coordinates: those of one turn are no neighbours, so what they do does not depend on their order, nor on
/// whose they are.
Optimized optimize(const Field& field, const Vertices& vertices, const Flips& flips,
                   const OptimizeOptions& options, Interrupt& interrupt, const Seams& seams = Seams());

} // namespace vdbtet
