/// @file Numbering.h
/// Which vertices are in the mesh, and the ids of points and tets: the exact size of the mesh, before any of
/// it is made.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "destinations/LocalVertices.h"
#include "flips/Flips.h"
#include "grading/Grading.h"
#include "tets/GradedTets.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Ids: those of a span's points start at firstPoint[span]; within a tile they go by rank in the used
/// masks, L_A before L_B, then TileChanges::copies. Those of its tets start at firstTet[span] and go in the
/// order of TileTets, then of the fringe, then by level; its boundary triangles likewise, in the order of
/// findBoundaryFaces().
/// @details Spans are counted on from tier to tier.
struct Numbering {
    std::vector<std::int64_t> firstSpan; ///< of each tier, and the number of all at the end

    /// By span, and the number of all at the end.
    std::vector<std::int64_t> firstPoint, firstTet, firstTriangle;

    /// The used vertices of L_A, by tier and record, and of L_B, by surface tile. A vertex that a tile shares
    /// with one of the tier below belongs to that.
    std::vector<std::vector<TileMask>> usedA;
    std::vector<TileMask> usedB;

    /// Of each tile of a run.
    std::array<TileMask, 2> usedInRun;
    std::int64_t runPoints = 0, runTets = 0;

    std::int64_t points() const { return firstPoint.back(); }
    std::int64_t tets() const { return firstTet.back(); }
    std::int64_t triangles() const { return firstTriangle.back(); } ///< of the boundary

    /// Tets whose shape is known, as no vertex of theirs has moved: of runs, and between octants.
    std::array<std::int64_t, kTetKinds> kinds{};
    std::vector<std::int64_t> tetsOfLevel; ///< by the level of their coarsest octant

    std::int64_t ambiguous = 0; ///< tets of four manifold vertices, which are not in the mesh
    /// The centroids of the first Places::kMost of these, in units of the lattice.
    std::vector<openvdb::Vec3d> ambiguousPlaces;
    openvdb::BBoxd bounds; ///< of the used points, world space
};

/// What a span has.
struct SpanCounts {
    std::int64_t points = 0, tets = 0;
    std::int32_t triangles = 0, ambiguous = 0;
};

/// The parts of a mesh that is numbered in several: each part looks at its own tiles, and numbers all spans.
class OtherParts {
public:
    virtual ~OtherParts() = default;

    /// @return whether a span with a record is this part's.
    virtual bool isOwn(int tier, const Span& span) const = 0;
    /// Fill in what the other parts have counted in a tier's spans with records.
    virtual void addCounts(int tier, const Spans& spans, std::vector<SpanCounts>& counts) = 0;
    /// Add up what is summed over the tiles with records: Numbering::kinds, tetsOfLevel and bounds.
    virtual void addSums(Numbering& numbering) = 0;
};

/// @param others  null where the mesh is numbered in one piece; else ambiguousPlaces are the part's own
/// @details Every vertex inside is used that exists. A manifold vertex is used iff one of its 14 lattice
/// neighbours is inside and not manifold: the edge to that neighbour is in the mesh, or, flipped, another
/// such edge of the same octahedron.
Numbering numberMesh(const Vertices& vertices, const Flips& flips, const Grading& grading, const Frame& frame,
                     Interrupt& interrupt, OtherParts* others = nullptr);

} // namespace vdbtet
