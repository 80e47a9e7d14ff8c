/// @file VtuCompressed.cc
/// The VTK XML file format with raw appended data, compressed by zlib: of each array the number of its
/// blocks, their size before compression, that of a last one which is smaller (else 0), and their sizes after
/// it, then the blocks, one behind the other.
///
/// The sizes of the arrays before it tell where an array starts. So one array is written in place, the
/// connectivity, which takes most; the others wait in files of their own.
#include "io/formats/CompressedFormat.h"
#include "io/formats/Names.h"

#include <algorithm>
#include <deque>
#include <initializer_list>

namespace vdbtet {

namespace {

using Role = VtkArray::Role;

const char* nameOf(NumberType type) {
    switch (type) {
    case NumberType::Float32:
        return "Float32";
    case NumberType::Float64:
        return "Float64";
    case NumberType::Int32:
        return "Int32";
    case NumberType::Int64:
        return "Int64";
    case NumberType::UInt8:
        break;
    }
    return "UInt8";
}

/// Of arrays that are no fields, by role.
constexpr const char* kNames[] = {"Points", "connectivity", "offsets", "types"};

/// @return the element of an array, of a length that does not depend on the offset
std::string dataArray(const VtkArray& array, std::uint64_t offset) {
    const bool isField = array.role == Role::PointField || array.role == Role::CellField;
    const bool isVector = isField || array.role == Role::Points; // a tet's ids are not components
    const std::string digits = std::to_string(offset);
    return std::string("        <DataArray type=\"") + nameOf(array.type) + "\" Name=\"" +
           (isField ? xmlName(array.name) : kNames[int(array.role)]) + "\"" +
           (isVector ? " NumberOfComponents=\"" + std::to_string(array.components) + "\"" : "") +
           " format=\"appended\" offset=\"" + digits + "\"" + std::string(20 - digits.size(), ' ') + "/>\n";
}

class VtuCompressed final : public CompressedFormat {
public:
    VtuCompressed(OutputFile& file, const MeshTotals& totals, int level);

    std::uint64_t finish() override;

private:
    /// An array on its way.
    struct Part {
        /// Three numbers about the blocks, and the sizes of those that came.
        std::vector<std::uint64_t> table;
        std::uint64_t tableBytes; ///< when all have come
        std::uint64_t offset = 0; ///< of the table in the file
    };

    void put(const BlockDeflater::Block& block) override;
    std::string header() const;
    std::uint64_t appendedAt(const Part& part) const { return part.offset - mParts[kDirect].offset; }

    static constexpr std::size_t kDirect = std::size_t(Role::Connectivity);

    OutputFile& mFile;
    std::int64_t mPoints, mTets;
    std::vector<Part> mParts;       ///< by array
    std::deque<SpoolFile> mSpools;  ///< by array
    std::uint64_t mDirectBytes = 0; ///< of blocks in place
};

VtuCompressed::VtuCompressed(OutputFile& file, const MeshTotals& totals, int level)
    : CompressedFormat(totals, level), mFile(file), mPoints(totals.points), mTets(totals.tets) {
    for (const VtkArray& array : mArrays) {
        const std::size_t recordBytes = array.recordBytes(),
                          blockRecords = BlockDeflater::kBlockBytes / recordBytes;
        mDeflater.addArray({recordBytes, blockRecords});
        const auto records = std::uint64_t(array.records),
                   blocks = (records + blockRecords - 1) / blockRecords;
        Part part;
        part.table = {blocks, blockRecords * recordBytes, records % blockRecords * recordBytes};
        part.tableBytes = 8 * (3 + blocks);
        mParts.push_back(std::move(part));
        mSpools.emplace_back(file);
    }
    mParts[kDirect].offset = header().size();
}

void VtuCompressed::put(const BlockDeflater::Block& block) {
    Part& part = mParts[block.array];
    part.table.push_back(block.deflatedBytes);
    if (block.array != kDirect)
        return mSpools[block.array].append(block.deflated.data(), block.deflatedBytes);
    mFile.writeAt(part.offset + part.tableBytes + mDirectBytes, block.deflated.data(), block.deflatedBytes);
    mDirectBytes += block.deflatedBytes;
}

std::uint64_t VtuCompressed::finish() {
    mDeflater.finish();
    std::uint64_t end = mParts[kDirect].offset + mParts[kDirect].tableBytes + mDirectBytes;
    for (std::size_t a = 0; a < mParts.size(); ++a) {
        Part& part = mParts[a];
        if (a != kDirect) {
            part.offset = end;
            mSpools[a].copyTo(part.offset + part.tableBytes);
            end += part.tableBytes + mSpools[a].size();
        }
        mFile.writeAt(part.offset, part.table.data(), part.tableBytes);
    }
    const std::string front = header(), back = "\n  </AppendedData>\n</VTKFile>\n";
    mFile.writeAt(0, front.data(), front.size());
    mFile.writeAt(end, back.data(), back.size());
    return end + back.size();
}

std::string VtuCompressed::header() const {
    const auto arrays = [this](const char* element, std::initializer_list<Role> roles) {
        std::string text;
        for (std::size_t a = 0; a < mArrays.size(); ++a) {
            if (std::find(roles.begin(), roles.end(), mArrays[a].role) == roles.end()) continue;
            text += dataArray(mArrays[a], appendedAt(mParts[a]));
        }
        return text.empty() ? "" : "      <" + (element + (">\n" + text)) + "      </" + element + ">\n";
    };
    const char* byteOrder = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "BigEndian" : "LittleEndian";
    return std::string("<?xml version=\"1.0\"?>\n"
                       "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
           byteOrder +
           "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
           "  <UnstructuredGrid>\n"
           "    <Piece NumberOfPoints=\"" +
           std::to_string(mPoints) + "\" NumberOfCells=\"" + std::to_string(mTets) + "\">\n" +
           arrays("Points", {Role::Points}) +
           arrays("Cells", {Role::Connectivity, Role::Offsets, Role::Types}) +
           arrays("PointData", {Role::PointField}) + arrays("CellData", {Role::CellField}) +
           "    </Piece>\n"
           "  </UnstructuredGrid>\n"
           "  <AppendedData encoding=\"raw\">\n"
           "_";
}

} // namespace

std::unique_ptr<CompressedFormat> makeVtuCompressed(OutputFile& file, const MeshTotals& totals, int level) {
    return std::make_unique<VtuCompressed>(file, totals, level);
}

} // namespace vdbtet
