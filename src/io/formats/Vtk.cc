/// @file Vtk.cc
/// The legacy VTK file format, binary, which is big-endian whatever the machine.
///
/// It is version 3.0, whose cells are int32 "4 a b c d", as long as the ids and the count of those numbers
/// fit: every reader knows that one, SOFA's among them. Larger meshes take version 5.1, with int64 offsets
/// and connectivity as VTK 9 has them.
#include "io/formats/Format.h"
#include "io/formats/Names.h"

#include <limits>
#include <type_traits>

namespace vdbtet {

namespace {

constexpr std::int64_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kVtkTetra = 10;

template <typename T, typename Value>
void storeBigEndianAs(char* to, const Value* values, std::size_t count) {
    storeAs<T>(to, values, count);
    if (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__) return;
    for (std::size_t i = 0; i < count; ++i, to += sizeof(T)) {
        std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t> bits;
        std::memcpy(&bits, to, sizeof bits);
        if constexpr (sizeof bits == 4) {
            bits = __builtin_bswap32(bits);
        } else {
            bits = __builtin_bswap64(bits);
        }
        std::memcpy(to, &bits, sizeof bits);
    }
}

class Vtk final : public Format {
public:
    explicit Vtk(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mFloat32, mInt32;
    RecordLayout::Section mPoints, mCells, mTypes;
    RecordLayout::Section mOffsets; ///< in version 5.1
    FieldPlaces<RecordLayout::Section> mFields;
};

Vtk::Vtk(const MeshTotals& totals)
    : mFloat32(totals.float32Suffices),
      mInt32(totals.points - 1 <= kMaxInt32 && totals.tets <= kMaxInt32 / 5) {
    const std::string points = std::to_string(totals.points), tets = std::to_string(totals.tets);
    RecordLayout layout;
    layout.text(std::string("# vtk DataFile Version ") + (mInt32 ? "3.0" : "5.1") +
                "\nvdbtet\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS " + points +
                (mFloat32 ? " float\n" : " double\n"));
    mPoints = layout.records(totals.points, 3 * std::size_t(mFloat32 ? 4 : 8));
    if (mInt32) {
        layout.text("\nCELLS " + tets + " " + std::to_string(5 * totals.tets) + "\n");
        mCells = layout.records(totals.tets, 5 * 4);
    } else {
        layout.text("\nCELLS " + std::to_string(totals.tets + 1) + " " + std::to_string(4 * totals.tets) +
                    "\nOFFSETS vtktypeint64\n");
        layout.binary(std::int64_t(0));
        mOffsets = layout.records(totals.tets, 8);
        layout.text("\nCONNECTIVITY vtktypeint64\n");
        mCells = layout.records(totals.tets, 4 * 8);
    }
    layout.text("\nCELL_TYPES " + tets + "\n");
    mTypes = layout.records(totals.tets, 4);
    layout.text("\n");
    const auto sections = [&layout](const std::string& header, const std::vector<MeshField>& fields,
                                    std::int64_t records) {
        std::vector<RecordLayout::Section> places;
        const std::string count = std::to_string(records);
        if (!fields.empty())
            layout.text(header + " " + count + "\nFIELD FieldData " + std::to_string(fields.size()) + "\n");
        for (const MeshField& field : fields) {
            layout.text(percentName(field.name) + " " + std::to_string(field.components) + " " + count +
                        " float\n");
            places.push_back(layout.records(records, 4 * std::size_t(field.components)));
            layout.text("\n");
        }
        return places;
    };
    mFields.points = sections("POINT_DATA", totals.pointFields, totals.points);
    mFields.cells = sections("CELL_DATA", totals.cellFields, totals.tets);
    mLayouts.push_back(std::move(layout));
}

void Vtk::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        const double* from = chunk.points[i].asPointer();
        mFloat32 ? storeBigEndianAs<float>(to, from, 3 * n) : storeBigEndianAs<double>(to, from, 3 * n);
    });
    file.put(mCells, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        if (!mInt32) {
            storeBigEndianAs<std::int64_t>(to, chunk.tets[i].data(), 4 * n);
            return;
        }
        for (std::size_t k = 0; k < n; ++k, to += 5 * 4) {
            const std::int64_t corners = 4;
            storeBigEndianAs<std::int32_t>(to, &corners, 1);
            storeBigEndianAs<std::int32_t>(to + 4, chunk.tets[i + k].data(), 4);
        }
    });
    if (!mInt32) {
        file.put(mOffsets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
            for (std::size_t k = 0; k < n; ++k) {
                const std::int64_t end = 4 * (chunk.firstTet + std::int64_t(i + k) + 1);
                storeBigEndianAs<std::int64_t>(to + 8 * k, &end, 1);
            }
        });
    }
    file.put(mTypes, chunk.firstTet, chunk.tets.size(), [](std::size_t, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k) storeBigEndianAs<std::int32_t>(to + 4 * k, &kVtkTetra, 1);
    });
    mFields.forEach(chunk, [&file](const RecordLayout::Section& section, std::int64_t first,
                                   std::size_t count, const ArrayView<float>& values) {
        const std::size_t components = section.recordBytes / 4;
        file.put(section, first, count, [&](std::size_t i, std::size_t n, char* to) {
            storeBigEndianAs<float>(to, &values[i * components], n * components);
        });
    });
}

} // namespace

std::unique_ptr<Format> makeVtk(const MeshTotals& totals) { return std::make_unique<Vtk>(totals); }

} // namespace vdbtet
