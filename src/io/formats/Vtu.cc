/// @file Vtu.cc
/// The VTK XML file format with raw appended data (version 1.0, UInt64 headers): a text header, then blocks
/// [UInt64 bytes][data], each at an offset known from the totals alone.
#include "io/formats/Format.h"
#include "io/formats/Names.h"

#include <limits>

namespace vdbtet {

namespace {

constexpr std::int64_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();
constexpr char kVtkTetra = 10;

/// An array of the file.
struct Block {
    std::string type, name;
    std::string more; ///< attributes
    std::int64_t records;
    std::size_t recordBytes;
    std::uint64_t bytes() const { return std::uint64_t(records) * recordBytes; }
};

class Vtu final : public Format {
public:
    explicit Vtu(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mFloat32, mInt32Connectivity, mInt32Offsets;
    RecordLayout::Section mPoints, mConnectivity, mOffsets, mTypes;
    FieldPlaces<RecordLayout::Section> mFields;
};

Vtu::Vtu(const MeshTotals& totals)
    : mFloat32(totals.float32Suffices), mInt32Connectivity(totals.points - 1 <= kMaxInt32),
      mInt32Offsets(totals.tets <= kMaxInt32 / 4) {
    const Block points{mFloat32 ? "Float32" : "Float64", "Points", " NumberOfComponents=\"3\"", totals.points,
                       3 * std::size_t(mFloat32 ? 4 : 8)};
    const Block connectivity{mInt32Connectivity ? "Int32" : "Int64", "connectivity", "", totals.tets,
                             4 * std::size_t(mInt32Connectivity ? 4 : 8)};
    const Block offsets{mInt32Offsets ? "Int32" : "Int64", "offsets", "", totals.tets,
                        std::size_t(mInt32Offsets ? 4 : 8)};
    const Block types{"UInt8", "types", "", totals.tets, 1};
    const auto blocksOf = [](const std::vector<MeshField>& fields, std::int64_t records) {
        std::vector<Block> blocks;
        for (const MeshField& field : fields) {
            blocks.push_back({"Float32", xmlName(field.name),
                              " NumberOfComponents=\"" + std::to_string(field.components) + "\"", records,
                              4 * std::size_t(field.components)});
        }
        return blocks;
    };
    const std::vector<Block> pointFields = blocksOf(totals.pointFields, totals.points),
                             cellFields = blocksOf(totals.cellFields, totals.tets);

    std::uint64_t appended = 0;
    const auto array = [&appended](const Block& block) {
        const std::string element = std::string("        <DataArray type=\"") + block.type + "\" Name=\"" +
                                    block.name + "\"" + block.more + " format=\"appended\" offset=\"" +
                                    std::to_string(appended) + "\"/>\n";
        appended += 8 + block.bytes();
        return element;
    };
    const char* byteOrder = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "BigEndian" : "LittleEndian";
    std::string header = std::string("<?xml version=\"1.0\"?>\n"
                                     "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
                         byteOrder +
                         "\" header_type=\"UInt64\">\n"
                         "  <UnstructuredGrid>\n"
                         "    <Piece NumberOfPoints=\"" +
                         std::to_string(totals.points) + "\" NumberOfCells=\"" + std::to_string(totals.tets) +
                         "\">\n"
                         "      <Points>\n";
    header += array(points);
    header += "      </Points>\n"
              "      <Cells>\n";
    for (const Block* block : {&connectivity, &offsets, &types}) header += array(*block);
    header += "      </Cells>\n";
    const auto data = [&](const std::string& element, const std::vector<Block>& blocks) {
        if (blocks.empty()) return;
        header += "      <" + element + ">\n";
        for (const Block& block : blocks) header += array(block);
        header += "      </" + element + ">\n";
    };
    data("PointData", pointFields);
    data("CellData", cellFields);
    header += "    </Piece>\n"
              "  </UnstructuredGrid>\n"
              "  <AppendedData encoding=\"raw\">\n"
              "_";

    RecordLayout layout;
    layout.text(std::move(header));
    const auto append = [&layout](const Block& block) {
        layout.binary(block.bytes());
        return layout.records(block.records, block.recordBytes);
    };
    mPoints = append(points);
    mConnectivity = append(connectivity);
    mOffsets = append(offsets);
    mTypes = append(types);
    for (const Block& block : pointFields) mFields.points.push_back(append(block));
    for (const Block& block : cellFields) mFields.cells.push_back(append(block));
    layout.text("\n  </AppendedData>\n</VTKFile>\n");
    mLayouts.push_back(std::move(layout));
}

void Vtu::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        const double* from = chunk.points[i].asPointer();
        mFloat32 ? storeAs<float>(to, from, 3 * n) : storeAs<double>(to, from, 3 * n);
    });
    file.put(mConnectivity, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        const std::int64_t* from = chunk.tets[i].data();
        mInt32Connectivity ? storeAs<std::int32_t>(to, from, 4 * n) : storeAs<std::int64_t>(to, from, 4 * n);
    });
    file.put(mOffsets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k) {
            const std::int64_t end = 4 * (chunk.firstTet + std::int64_t(i + k) + 1);
            if (mInt32Offsets) {
                storeAs<std::int32_t>(to + 4 * k, &end, 1);
            } else {
                storeAs<std::int64_t>(to + 8 * k, &end, 1);
            }
        }
    });
    file.put(mTypes, chunk.firstTet, chunk.tets.size(),
             [](std::size_t, std::size_t n, char* to) { std::memset(to, kVtkTetra, n); });
    mFields.forEach(chunk, [&file](const RecordLayout::Section& section, std::int64_t first,
                                   std::size_t count, const ArrayView<float>& values) {
        const std::size_t components = section.recordBytes / 4;
        file.put(section, first, count, [&](std::size_t i, std::size_t n, char* to) {
            storeAs<float>(to, &values[i * components], n * components);
        });
    });
}

} // namespace

std::unique_ptr<Format> makeVtu(const MeshTotals& totals) { return std::make_unique<Vtu>(totals); }

} // namespace vdbtet
