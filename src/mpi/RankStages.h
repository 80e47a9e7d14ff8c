/// @file RankStages.h
/// The stages that need other ranks' records: each does its own tiles, then gets those of the borrowed ones.
#pragma once

#include "mpi/Comm.h"
#include "mpi/TileExchange.h"

#include "destinations/LocalVertices.h"
#include "flips/Flips.h"
#include "labels/Labels.h"

namespace vdbtet::mpi {

/// labelVertices() of the whole mesh.
/// @return the masks of own tiles and of those beside; the sums of all ranks
Labels labelPart(Comm& comm, TileExchange& beside, const Layout& layout, const Arrows& arrows,
                 Interrupt& interrupt);

/// Get the destinations of the tiles beside, whose labels are known.
void borrowDestinations(TileExchange& beside, const Labels& labels, Destinations& destinations);

/// chooseFlips() of the whole mesh.
/// @return those of own tiles and of those beside; the sums of all ranks; no places
Flips flipPart(Comm& comm, TileExchange& beside, const Vertices& vertices, int version, Interrupt& interrupt);

} // namespace vdbtet::mpi
