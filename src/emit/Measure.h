/// @file Measure.h
/// Counts and judges the mesh before any of it is written.
#pragma once

#include "bcc/Frame.h"
#include "flips/Flips.h"
#include "numbering/Numbering.h"

#include <vdbtet/Quality.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdbtet {

/// The tets that an interior tile owns: 12 a cell.
constexpr std::int64_t kInteriorTets = 12 * TileMask::kSize;

struct Measure {
    /// The first tet of each span of the layout, and the number of all tets at the end.
    std::vector<std::int64_t> first;
    std::int64_t tets() const { return first.back(); }

    std::int64_t ambiguous = 0;
    std::int64_t boundaryTriangles = 0;
    AngleStats angles;
    openvdb::BBoxd bounds; ///< of the used points, world space
};

Measure measureMesh(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
                    const Frame& frame, Interrupt& interrupt);

} // namespace vdbtet
