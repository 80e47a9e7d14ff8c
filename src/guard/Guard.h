/// @file Guard.h
/// Where version 3 leaves a bad tet, its vertices go back to the rule of version 2.
#pragma once

#include "Parallel.h"
#include "cuts/Arrows.h"
#include "destinations/LocalVertices.h"
#include "flips/QualityFlips.h"
#include "tiles/Seams.h"

#include <cstdint>

namespace vdbtet {

/// The angles that the guard lets pass, in degrees.
constexpr double kGuardMin = 18.0, kGuardMax = 146.0;

struct Guarded {
    VertexMasks flagged; ///< of each surface tile, the vertices whose rule is that of version 2
    /// And of all parts of the mesh:
    std::int64_t count = 0; ///< of flagged vertices
    int rounds = 0;
    std::int64_t tilesWithBad = 0; ///< that own a tet in the mesh that is bad still
};

/// The products that depend on what is flagged.
struct Guardable {
    Arrows& arrows;
    Labels& labels;
    Destinations& destinations;
    QualityFlips& flips;
};

/// @brief Flag all manifold vertices of bad tets, and make anew what depends on them, until there is none to
/// flag.
/// @param vertices  whose labels and destinations are those of @a products
/// @param products  with nothing flagged; then as if made once, with all that is flagged in the end
/// @details Bad are tets in the mesh with an angle beyond those above, with the whole octahedron if it is
/// flipped; and those dropped because all their vertices are manifold: there the shape is thin, and the rule
/// of version 2 keeps more of it. A flagged vertex moves along an edge, and at most half of it, as those of
/// version 2 do; so a tet that still has a bad angle has flagged vertices alone, and so has its octahedron if
/// that is flipped: for these (8.54, 164.18) is proven (docs/angles.md, theorem 4). Labels are a fixpoint of
/// all arrows, so they are made anew as a whole, by masks; all else in the tiles that they change.
Guarded guardAngles(const Field& field, double tau, const Vertices& vertices, const Guardable& products,
                    Interrupt& interrupt, const Seams& seams = Seams());

} // namespace vdbtet
