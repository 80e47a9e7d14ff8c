/// @file Piece.h
/// A rank's part of a mesh as a .vtu file of its own.
#pragma once

#include "io/OutputFile.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vdbtet::mpi {

/// Points whose ids follow each other.
struct PointRange {
    std::int64_t first, count;
    std::int64_t local; ///< number of the first in the piece

    std::int64_t end() const { return first + count; }
};

/// @param ranges  ascending
/// @return the number of a point in the piece, or -1 where it is none of these
std::int64_t localOf(const std::vector<PointRange>& ranges, std::int64_t id);

/// @param tets  of point ids
/// @return the ids of their points that are in no range, ascending
std::vector<std::int64_t> findGhosts(const SpoolFile& tets, std::int64_t tetCount,
                                     const std::vector<PointRange>& ranges);

struct Piece {
    const std::vector<PointRange>& ranges;     ///< of own points
    const std::vector<std::int64_t>& ghosts;   ///< ids, ascending
    const std::vector<openvdb::Vec3d>& places; ///< of the ghosts
    std::int64_t points, tets;                 ///< own
    bool float32;                              ///< coordinates
};

/// @brief Write a piece: VTK XML, raw appended.
/// @param points  own, as double
/// @param tets    of point ids
/// @return the size of the file
std::uint64_t writePiece(const Piece& piece, const SpoolFile& points, const SpoolFile& tets,
                         OutputFile& file);

const char* byteOrder();

/// @return a text as XML has it.
std::string xmlText(const std::string& text);

} // namespace vdbtet::mpi
