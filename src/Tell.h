/// @file Tell.h
/// What of the products is told to the caller and to the sink.
#pragma once

#include "bcc/Frame.h"
#include "flips/Flips.h"
#include "labels/Labels.h"
#include "numbering/Numbering.h"
#include "optimize/Optimize.h"
#include "quality/AngleSum.h"

#include <vdbtet/MeshSink.h>
#include <vdbtet/VolumeToTets.h>

namespace vdbtet {

void tellLabels(const Labels& labels, const Flips& flips, Report& report);

/// Also the sharpest bounds that are proven for all tets of a run (docs/angles.md). After tellLabels(), and
/// after the report has what repair did.
/// @param passed  whether the guard of version 3 has left no tet beyond its limits
/// @throw NoSurface where no tet is left
/// @throw TooLarge for more tets than Options::maxTets
void tellNumbers(const Numbering& numbering, const Options& options, bool passed, Report& report);

/// @param optimized  null where it was not asked for
void tellAngles(AngleSum& angles, const Optimized* optimized, Report& report);

/// @throw TooLarge where double cannot resolve the lattice
MeshTotals totalsOf(const Numbering& numbering, const Frame& frame);

} // namespace vdbtet
