/// @file MeshSink.h
/// Where a mesh goes: the interface that every writer and every in-memory mesh implements.
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbtet {

/// Four point ids, ordered such that det(p1-p0, p2-p0, p3-p0) > 0 (VTK_TETRA).
using Tet = std::array<std::int64_t, 4>;

/// Three point ids of a boundary face, counter-clockwise from outside.
using Triangle = std::array<std::int64_t, 3>;

/// Values at the points, or in the tets, of a mesh, float32.
struct MeshField {
    std::string name;
    int components = 1; ///< numbers a point or tet: 1 or 3
};

/// The exact size of a mesh, known before the first chunk is made.
struct MeshTotals {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::int64_t triangles = 0; ///< faces of exactly one tet
    /// World-space bounding box of the points.
    openvdb::BBoxd bounds;
    /// True where rounding a coordinate to float32 turns no dihedral angle by more than 0.01 degrees.
    bool float32Suffices = false;
    /// What comes with the points and the tets; empty unless a FieldSampler is between.
    std::vector<MeshField> pointFields, cellFields;
};

/// A view of consecutive values that someone else owns.
template <typename T>
class ArrayView {
public:
    ArrayView() = default;
    ArrayView(const T* data, std::size_t size) : mData(data), mSize(size) {}

    const T* data() const { return mData; }
    std::size_t size() const { return mSize; }
    bool empty() const { return mSize == 0; }
    const T* begin() const { return mData; }
    const T* end() const { return mData + mSize; }
    const T& operator[](std::size_t i) const { return mData[i]; }

private:
    const T* mData = nullptr;
    std::size_t mSize = 0;
};

/// A consecutive run of the mesh. Points, tets and triangles are numbered from 0 in the order of the chunks;
/// a tet or triangle may name points of any other chunk.
struct MeshChunk {
    std::int64_t firstPoint = 0;
    std::int64_t firstTet = 0;
    std::int64_t firstTriangle = 0;
    /// World-space positions of the points firstPoint, firstPoint + 1, ...; valid during the call.
    ArrayView<openvdb::Vec3d> points;
    /// Point ids of the tets firstTet, firstTet + 1, ...; valid during the call.
    ArrayView<Tet> tets;
    /// The boundary, if the sink wants it: the triangles firstTriangle, firstTriangle + 1, ..., which are
    /// faces of tets of this chunk; valid during the call.
    ArrayView<Triangle> triangles;
    /// With the triangles: the ids of the chunk's points on the surface, ascending. All corners of all
    /// triangles are among those of some chunk.
    ArrayView<std::int64_t> surfacePoints;
    /// For each tet, if the sink wants them: the mean of its corners, world space, and its smallest dihedral
    /// angle, in degrees; valid during the call.
    ArrayView<openvdb::Vec3d> centroids;
    ArrayView<float> minDihedrals;
    /// For each of MeshTotals::pointFields and cellFields the values at the chunk's points and in its tets,
    /// the components of one side by side; valid during the call.
    std::vector<ArrayView<float>> pointFields, cellFields;
};

/// What else of a chunk a sink wants than its points and tets: nothing of it is made for those who do not.
struct MeshWants {
    bool triangles = false; ///< and surfacePoints
    bool centroids = false;
    bool minDihedrals = false;
};

/// Room for the points and tets of a chunk.
struct ChunkMemory {
    openvdb::Vec3d* points = nullptr;
    Tet* tets = nullptr;
};

/// @brief Receives a mesh: begin() once, chunk() for each part, end() once when the mesh is whole.
/// @details A sink gets its chunks one at a time and in order, though not all from the same thread, unless it
/// is concurrent(). A run that is cancelled or that fails never calls end(); a sink that owns a file then
/// leaves nothing behind when it is destroyed. Exceptions thrown by a sink end the run and reach the caller;
/// an Error other than FileError then has the grid's name in front.
class MeshSink {
public:
    virtual ~MeshSink() = default;
    /// @return false to receive no chunks: totals alone were wanted. end() is called nevertheless.
    virtual bool begin(const MeshTotals& totals) = 0;
    virtual void chunk(const MeshChunk& chunk) = 0;
    virtual void end() = 0;

    /// @return true where several threads may call chunk() at once, and in any order. Much the faster way:
    /// each chunk knows its place in the mesh.
    virtual bool concurrent() const { return false; }

    /// @return what the chunks shall have besides points and tets. Asked once, after begin().
    virtual MeshWants wants() const { return {}; }

    /// @brief For a sink that has memory for the whole mesh: where the chunk shall be made that starts with
    /// these.
    /// @return null pointers, the default, for memory of the mesher's own
    /// @details Called before chunk(), by several threads at once whether the sink is concurrent() or not.
    virtual ChunkMemory memory(std::int64_t firstPoint, std::int64_t firstTet) {
        static_cast<void>(firstPoint);
        static_cast<void>(firstTet);
        return {};
    }
};

} // namespace vdbtet
