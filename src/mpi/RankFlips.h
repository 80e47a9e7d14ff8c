/// @file RankFlips.h
/// The flips of own and borrowed tiles, and the counts of all ranks.
#pragma once

#include "mpi/Comm.h"

#include "destinations/LocalVertices.h"
#include "flips/Flips.h"
#include "tiles/Seams.h"

namespace vdbtet::mpi {

/// chooseFlips() of the whole mesh.
/// @return those of own tiles and of those beside; the sums of all ranks; no places
Flips flipPart(Comm& comm, const Seams& beside, const Vertices& vertices, int version, Interrupt& interrupt);

/// Make the counts of flips those of all ranks.
void sumFlips(const Comm& comm, Flips& flips);

} // namespace vdbtet::mpi
