/// @file VtkArrays.h
/// The arrays that VTK's formats make of a mesh, whatever the file around them.
#pragma once

#include "io/NumberType.h"

#include <vdbtet/MeshSink.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbtet {

/// VTK_TETRA.
constexpr char kVtkTetra = 10;

/// An array that has a record for each point, or for each tet.
struct VtkArray {
    enum class Role { Points, Connectivity, Offsets, Types, PointField, CellField };

    Role role;
    std::string name; ///< of a field
    NumberType type;
    int components; ///< numbers a record
    std::int64_t records;
    std::size_t field = 0; ///< which of the chunk's, for a field

    std::size_t recordBytes() const { return bytesOf(type) * std::size_t(components); }
    std::uint64_t bytes() const { return std::uint64_t(records) * recordBytes(); }

    /// A run of records.
    struct Run {
        std::int64_t first;
        std::size_t count;
    };
    /// @return the records that a chunk has
    Run runOf(const MeshChunk& chunk) const;
    /// Make the records i to i + n of the chunk's. Offsets are where tets end, the first at 4.
    void encode(const MeshChunk& chunk, std::size_t i, std::size_t n, char* to) const;
};

/// @return the arrays of a mesh in the order of Role. Connectivity and offsets are of one type, as
/// vtkCellArray wants them, and have 64 bits only where 32 are too few.
std::vector<VtkArray> vtkArrays(const MeshTotals& totals);

} // namespace vdbtet
