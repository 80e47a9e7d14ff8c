/// @file Emit.h
/// Streams the mesh into a sink.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "emit/TileMeasurer.h"
#include "numbering/Numbering.h"

#include <vdbtet/MeshSink.h>

namespace vdbtet {

/// @brief Make the chunks in parallel and hand them to @a sink; at most a few chunks exist at a time.
/// @return what was measured on the way: while files wait for the disk there is time for it
/// @details Stops between two chunks when interrupted.
AngleSum emitMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                  const Numbering& numbering, const Frame& frame, MeshSink& sink, Interrupt& interrupt);

/// Measure the mesh without making it.
AngleSum measureMesh(const Vertices& vertices, const Flips& flips, const Grading& grading,
                     const Numbering& numbering, const Frame& frame, Interrupt& interrupt);

} // namespace vdbtet
