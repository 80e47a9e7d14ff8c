/// @file RankRepair.h
/// repairBoundary() of the whole mesh.
#pragma once

#include "mpi/Comm.h"

#include "repair/Repair.h"

namespace vdbtet::mpi {

/// @brief Gather what is near the vertices that are bad, and have all ranks mend it alike.
/// @param layout  of the rank's part
/// @return the changes of its tiles, and of the borrowed ones; the sums of all ranks; no places
/// @details Bad vertices are few where the lattice resolves the shape. Memory grows with what is around them.
Repair repairPart(Comm& comm, const Vertices& vertices, const Flips& flips, Boundary mode,
                  Interrupt& interrupt);

} // namespace vdbtet::mpi
