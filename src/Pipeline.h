/// @file Pipeline.h
/// The whole method on one screen, for any field.
#pragma once

#include "Parallel.h"
#include "bcc/Frame.h"
#include "field/Field.h"

#include <vdbtet/VolumeToTets.h>

namespace vdbtet {

/// Mesh the inside of @a field into @a sink; fills in what the run did. The report's description of the grid
/// is the caller's.
void runPipeline(const Field& field, const Frame& frame, const Options& options, MeshSink& sink,
                 Interrupt& interrupt, Report& report);

} // namespace vdbtet
