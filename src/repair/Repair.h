/// @file Repair.h
/// Makes the boundary of the mesh a surface where the lattice does not resolve the shape: there, dropped
/// tets leave edges with four boundary triangles and points where parts of the boundary merely touch.
#pragma once

#include "Parallel.h"
#include "destinations/Changes.h"
#include "destinations/LocalVertices.h"
#include "flips/Flips.h"
#include "repair/BoundaryCheck.h"

#include <vdbtet/VolumeToTets.h>

#include <cstdint>
#include <vector>

namespace vdbtet {

struct Repair {
    Changes changes;       ///< empty where nothing was
    BoundaryCounts counts; ///< what was found and done
    /// Where the first Places::kMost of what was found are, in units of the lattice.
    std::vector<openvdb::Vec3d> pinched;
    /// Whether tets are concerned that no surface tile owns: then all is to be done again with a margin of
    /// one more cell, where that cannot be.
    bool leavesSurface = false;
    /// The vertices of all tets that were put in or taken out, as VertexId.
    std::vector<std::int64_t> changed;
};

/// @brief Find the vertices where the boundary is not a surface, and mend it as far as @a mode says.
/// @details In this order: fill gaps with ambiguous tets, as long as that makes fewer bad vertices and their
/// angles are within Theorem 3's bound; take out tets where a fan of them has a tunnel, or touches itself
/// along an edge; have a point for each fan of tets that is left at a vertex. Fills and removals go in rounds
/// over a frozen state: each bad vertex has one candidate, which wins if no other one of a lower vertex
/// shares a vertex with it. So neither order nor threads matter, and nothing far from a bad vertex changes.
Repair repairBoundary(const Vertices& vertices, const Flips& flips, Boundary mode, Interrupt& interrupt);

/// @brief The same from the vertices on that findPinched() has found.
/// @details Reads no more than the tiles within two of a bad or changed vertex's.
Repair mendBoundary(const Vertices& vertices, const Flips& flips, std::vector<std::int64_t> bad,
                    Boundary mode, Interrupt& interrupt);

} // namespace vdbtet
