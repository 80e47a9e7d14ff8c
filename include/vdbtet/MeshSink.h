/// @file MeshSink.h
/// Where a mesh goes: the interface that every writer and every in-memory mesh implements.
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// Four point ids, ordered such that det(p1-p0, p2-p0, p3-p0) > 0 (VTK_TETRA).
using Tet = std::array<std::int64_t, 4>;

/// The exact size of a mesh, known before the first chunk is made.
struct MeshTotals {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    /// World-space bounding box of the points.
    openvdb::BBoxd bounds;
    /// True where rounding a coordinate to float32 turns no dihedral angle by more than 0.01 degrees.
    bool float32Suffices = false;
};

/// A consecutive run of the mesh. Points and tets are numbered from 0 in the order of the chunks; a tet may
/// name points of chunks that come later.
struct MeshChunk {
    std::int64_t firstPoint = 0;
    std::int64_t firstTet = 0;
    /// World-space positions of the points firstPoint, firstPoint + 1, ...
    std::vector<openvdb::Vec3d> points;
    /// Point ids of the tets firstTet, firstTet + 1, ...
    std::vector<Tet> tets;
};

/// @brief Receives a mesh: begin() once, chunk() in order, end() once when the mesh is whole.
/// @details All calls come one at a time, though not all from the same thread. A run that is cancelled or
/// that fails never calls end(); a sink that owns a file then leaves nothing behind when it is destroyed.
/// Exceptions thrown by a sink end the run and reach the caller; an Error
/// other than FileError then has the grid's name in front.
class MeshSink {
public:
    virtual ~MeshSink() = default;
    /// @return false to receive no chunks: totals alone were wanted. end() is called nevertheless.
    virtual bool begin(const MeshTotals& totals) = 0;
    virtual void chunk(const MeshChunk& chunk) = 0;
    virtual void end() = 0;
};

} // namespace vdbtet
