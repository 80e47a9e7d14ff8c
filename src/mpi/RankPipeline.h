/// @file RankPipeline.h
/// The stages in order, for a rank's part of the tiles.
#pragma once

#include "mpi/Comm.h"
#include "mpi/RankPart.h"

#include "bcc/Frame.h"
#include "field/Field.h"

#include <memory>

namespace vdbtet::mpi {

/// @brief As runPipeline(), from known tiles on.
/// @param field     holds where the own tiles are, at least; let go of when nobody reads it any more
/// @param own       the numbers of the own tiles in the skeleton, ascending
/// @param margin    of Field::surfaceTiles(), that the skeleton has
/// @return false where that is not enough, on all ranks
bool runPart(Comm& comm, std::shared_ptr<const Field> field, const Frame& frame, const Options& options,
             Skeleton skeleton, const std::vector<std::int64_t>& own, int margin, MeshSink& sink,
             Report& report, RankReport& rankReport);

} // namespace vdbtet::mpi
