/// @file Emit.h
/// Streams the mesh into a sink.
#pragma once

#include "bcc/Frame.h"
#include "emit/Measure.h"

#include <vdbtet/MeshSink.h>

namespace vdbtet {

/// @brief Make the chunks in parallel and hand them to @a sink in order; at most a few chunks exist at a
/// time.
/// @details Stops between two chunks when interrupted.
void emitMesh(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
              const Measure& measure, const Frame& frame, MeshSink& sink, Interrupt& interrupt);

} // namespace vdbtet
