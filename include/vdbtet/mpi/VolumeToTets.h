/// @file mpi/VolumeToTets.h
/// One mesh made by many processes, the ranks of an MPI communicator.
#pragma once

#include <vdbtet/MeshSink.h>
#include <vdbtet/VolumeToTets.h>

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <string>

namespace vdbtet::mpi {

/// The grid that all ranks read, each its part of it; see readGrid().
struct GridSource {
    std::string path;
    std::string name = {};
};

/// Which rank does a place: a lattice tile of 8 x 8 x 8 cells, by its number along each axis. The same on all
/// ranks, for any place.
using Owner = std::function<int(const openvdb::Coord& tile)>;

/// What one rank did.
struct RankReport {
    std::string gridType;              ///< such as "float, level set"
    std::int64_t surfaceTiles = 0;     ///< its own
    std::int64_t borrowedTiles = 0;    ///< of others, whose records it kept
    std::int64_t tets = 0;             ///< that it made
    std::int64_t leaves = 0;           ///< of the grid, that it had while it worked
    std::int64_t sentToNeighbours = 0; ///< bytes of records, and the tets of
    std::int64_t sentToAll = 0;        ///< bytes that every rank got
};

/// @brief As vdbtet::volumeToTets(), but by all ranks of @a comm, each with its part of the tiles.
/// @param sink     each rank's own: gets the totals of the whole mesh, and of its chunks those that this rank
///                 makes, in ascending order unless it is concurrent. Chunks, ids and totals are those of
///                 one rank, bit for bit, whatever the number of ranks and the parts.
/// @param options  maxMemory is of this rank
/// @param owner    default: parts of equal work along a space-filling curve
/// @return the report of the whole mesh, on all ranks; its places are left empty, and its memory is that of
/// the largest rank
/// @details Collective. MPI is called by the calling thread alone (MPI_THREAD_FUNNELED), while the work is
/// done by all threads of the caller's tbb::task_arena. An error of one rank is thrown on all of them, but
/// for std::bad_alloc where memory is short between two stages: then end the job, by MPI_Abort().
/// @throw FileError  where the grid cannot be read
/// @throw BadOption, UnsupportedGrid, BadValue, NoSurface, UnboundedInside, TooLarge, and whatever the sinks
/// throw
Report volumeToTets(const GridSource& source, MeshSink& sink, const Options& options, MPI_Comm comm,
                    const Owner& owner = {}, RankReport* rankReport = nullptr);

} // namespace vdbtet::mpi
