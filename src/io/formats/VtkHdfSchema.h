/// @file VtkHdfSchema.h
/// The VTKHDF format, version 1.0: an unstructured grid of one partition.
#pragma once

#include "io/Hdf5File.h"
#include "io/formats/VtkArrays.h"

#include <vector>

namespace vdbtet {

/// An array of the mesh in the file.
struct VtkHdfArray {
    VtkArray array;
    Hdf5Array shape; ///< of numbers; offsets have one more than there are tets: 0 in front
    Hdf5File::Id id;
    std::uint64_t numbersARow; ///< of shape; a record of connectivity is four rows
    std::uint64_t rowsARecord() const { return std::uint64_t(array.components) / numbersARow; }
};

/// Make all groups, attributes, counts and arrays of a mesh.
/// @param chunkBytes  0 for arrays in one piece; else what chunks have at most
std::vector<VtkHdfArray> addVtkHdf(Hdf5File& file, const MeshTotals& totals, std::size_t chunkBytes);

} // namespace vdbtet
