/// @file Emit.h
/// Streams the mesh into a sink.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "emit/TileMeasurer.h"
#include "numbering/Numbering.h"

#include <vdbtet/MeshSink.h>

#include <cstdint>
#include <vector>

namespace vdbtet {

/// A place in the spans of all tiers, before a tile.
struct Place {
    std::int64_t span = 0;   ///< counted on from tier to tier
    std::int64_t offset = 0; ///< of the tile in its span
};

/// The tiles from begin up to end, of one span or several.
struct TileRange {
    Place begin, end;
};

/// @brief Make the chunks in parallel and hand them to @a sink; at most a few chunks exist at a time.
/// @param ranges  what to emit, in ascending order
/// @return what was measured on the way: while files wait for the disk there is time for it
/// @details Stops between two chunks when interrupted.
AngleSum emitMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                  const Numbering& numbering, const Frame& frame, const std::vector<TileRange>& ranges,
                  MeshSink& sink, Interrupt& interrupt);

/// Measure the mesh, or this part of it, without making it.
AngleSum measureMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                     const Numbering& numbering, const Frame& frame, Interrupt& interrupt,
                     const OtherParts* others = nullptr);

/// The whole mesh.
inline std::vector<TileRange> allOf(const Numbering& numbering) {
    return {{{0, 0}, {numbering.firstSpan.back(), 0}}};
}

} // namespace vdbtet
