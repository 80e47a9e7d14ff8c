/// @file TextRecords.h
/// Records of text: rows whose numbers are padded with spaces to columns of one width, so that each row has
/// its place in the file as a binary record has.
#pragma once

#include "io/RecordFile.h"

#include <vdbtet/MeshSink.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbtet {

/// How a format writes numbers.
struct TextNumbers {
    /// @param idOfFirst  of the first point, the first tet and the first triangle: 0 or 1
    TextNumbers(const MeshTotals& totals, std::int64_t idOfFirst);

    void useFloat32(bool use);

    std::int64_t firstId;
    std::size_t idWidth;
    bool float32;                         ///< round to float first, for the same values as in a binary format
    std::size_t realWidth;                ///< enough for every number to be read back as it was
    openvdb::Vec3d origin{0.0, 0.0, 0.0}; ///< taken off the coordinates
};

/// A section of rows of one pattern.
class TextRows {
public:
    TextRows() = default;

    /// @param pattern  text where '*' stands for the next coordinate, '#' for the next id, '@' for the id of
    /// the row itself and '~' for the next value of a field. A comma in front is left out of the first row.
    TextRows(RecordLayout& layout, std::int64_t count, const std::string& pattern,
             const TextNumbers& numbers);

    void put(RecordFile& file, std::int64_t first, const ArrayView<openvdb::Vec3d>& points,
             const std::vector<ArrayView<float>>& fields = {}) const;
    void put(RecordFile& file, std::int64_t first, const ArrayView<Tet>& tets,
             const std::vector<ArrayView<float>>& fields = {}) const;
    void put(RecordFile& file, std::int64_t first, const ArrayView<Triangle>& triangles) const;
    /// Rows of one field alone, of which there are @a count.
    void put(RecordFile& file, std::int64_t first, std::size_t count, const ArrayView<float>& values) const;

private:
    /// What a row may be made of.
    struct Row {
        const double* coordinates;
        const std::int64_t* ids;
    };
    template <typename RowAt>
    void putRows(RecordFile& file, std::int64_t first, std::size_t count,
                 const std::vector<ArrayView<float>>& fields, const RowAt& rowAt) const;
    char* write(char* to, std::int64_t number, const Row& row, const float* values) const;

    std::string mPattern;
    TextNumbers mNumbers{MeshTotals(), 0};
    RecordLayout::Section mSection;
};

/// @return the shortest text that is read back as @a value, of type float or double
template <typename Real>
std::string shortest(Real value);

/// @throw TooLarge where a mesh has more than @a most of what the format numbers
void requireAtMost(std::int64_t most, std::int64_t count, const char* what, const char* format);

} // namespace vdbtet
