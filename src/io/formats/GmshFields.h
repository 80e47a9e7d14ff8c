/// @file GmshFields.h
/// Fields as both versions of Gmsh's binary format have them: a section each, of rows of an int32 tag and
/// float64 values.
#pragma once

#include "io/formats/Format.h"
#include "io/formats/Names.h"
#include "io/formats/TextRecords.h"

#include <limits>

namespace vdbtet {

class GmshFields {
public:
    /// Behind the elements.
    void layOut(RecordLayout& layout, const MeshTotals& totals, const char* format) {
        mPlaces.points = sections(layout, "NodeData", totals.pointFields, totals.points, "points", format);
        mPlaces.cells = sections(layout, "ElementData", totals.cellFields, totals.tets, "tets", format);
    }

    void put(const MeshChunk& chunk, RecordFile& file) const {
        mPlaces.forEach(chunk, [&file](const RecordLayout::Section& section, std::int64_t first,
                                       std::size_t count, const ArrayView<float>& values) {
            const std::size_t components = (section.recordBytes - 4) / 8;
            file.put(section, first, count, [&](std::size_t i, std::size_t n, char* to) {
                for (std::size_t k = i; k < i + n; ++k, to += section.recordBytes) {
                    const std::int64_t tag = first + std::int64_t(k) + 1;
                    storeAs<std::int32_t>(to, &tag, 1);
                    storeAs<double>(to + 4, &values[k * components], components);
                }
            });
        });
    }

private:
    static std::vector<RecordLayout::Section> sections(RecordLayout& layout, const std::string& name,
                                                       const std::vector<MeshField>& fields,
                                                       std::int64_t records, const char* what,
                                                       const char* format) {
        std::vector<RecordLayout::Section> places;
        if (!fields.empty()) requireAtMost(std::numeric_limits<std::int32_t>::max(), records, what, format);
        for (const MeshField& field : fields) {
            // One string, one time, and three numbers: the step, the components and the rows.
            layout.text("$" + name + "\n1\n" + quotedName(field.name) + "\n1\n0\n3\n0\n" +
                        std::to_string(field.components) + "\n" + std::to_string(records) + "\n");
            places.push_back(layout.records(records, 4 + 8 * std::size_t(field.components)));
            layout.text("\n$End" + name + "\n");
        }
        return places;
    }

    FieldPlaces<RecordLayout::Section> mPlaces;
};

} // namespace vdbtet
