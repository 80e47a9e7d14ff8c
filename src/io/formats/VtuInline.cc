/// @file VtuInline.cc
/// The VTK XML file format with its arrays inline, in base64: valid XML, for readers that refuse Vtu.cc's.
///
/// Three bytes make a group of four characters, and the ids of a tet are no multiple of three bytes, so a
/// chunk may begin with a group whose first one or two bytes are of the tet before. Ids are little-endian
/// Int64 here, and no mesh has 2^48 points: these bytes are zeros. The chunk that has the last byte of a
/// group writes it.
#include "io/formats/Format.h"

#include <algorithm>
#include <array>

namespace vdbtet {

namespace {

constexpr std::uint64_t kVtkTetra = 10;

/// Encode up to three bytes.
void putGroup(char* to, const std::array<std::uint8_t, 3>& bytes, std::size_t count) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned group = unsigned(bytes[0]) << 16 | unsigned(bytes[1]) << 8 | bytes[2];
    for (std::size_t i = 0; i < 4; ++i) to[i] = i <= count ? kDigits[group >> (18 - 6 * i) & 63] : '=';
}

/// An array of the file.
struct Block {
    std::uint64_t words = 0;
    std::size_t wordBytes = 0;
    RecordLayout::Section groups;
    std::uint64_t bytes() const { return words * wordBytes; }
};

/// Write the words from @a first on; @a word(i) is the bits of word i, or of the one before the first.
template <typename Word>
void put(RecordFile& file, const Block& block, std::int64_t first, std::size_t count, const Word& word) {
    if (count == 0) return;
    const std::uint64_t begin = std::uint64_t(first) * block.wordBytes, end = begin + count * block.wordBytes;
    const std::uint64_t firstGroup = begin / 3, endGroup = (end == block.bytes() ? end + 2 : end) / 3;
    const auto encode = [&](std::size_t done, std::size_t n, char* to) {
        std::uint64_t at = 3 * (firstGroup + done);
        for (std::size_t i = 0; i < n; ++i, at += 3) {
            const std::size_t some = std::min<std::uint64_t>(3, block.bytes() - at);
            std::array<std::uint8_t, 3> bytes{};
            for (std::size_t k = 0; k < some; ++k) {
                const std::uint64_t bits = word(std::int64_t((at + k) / block.wordBytes));
                bytes[k] = std::uint8_t(bits >> (8 * ((at + k) % block.wordBytes)));
            }
            putGroup(to + 4 * i, bytes, some);
        }
    };
    file.put(block.groups, std::int64_t(firstGroup), endGroup - firstGroup, encode);
}

template <typename Bits, typename T>
Bits bitsOf(T value) {
    Bits bits;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

class VtuInline final : public Format {
public:
    explicit VtuInline(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mFloat32;
    Block mPoints, mConnectivity, mOffsets, mTypes;
};

VtuInline::VtuInline(const MeshTotals& totals) : mFloat32(totals.float32Suffices) {
    RecordLayout layout;
    const auto array = [&layout](const std::string& attributes, std::int64_t words, std::size_t wordBytes) {
        Block block{std::uint64_t(words), wordBytes, {}};
        std::string header(12, ' '); // the UInt64 of the size, encoded on its own
        for (std::size_t at = 0; at < 8; at += 3) {
            std::array<std::uint8_t, 3> bytes{};
            for (std::size_t k = 0; at + k < 8 && k < 3; ++k)
                bytes[k] = std::uint8_t(block.bytes() >> (8 * (at + k)));
            putGroup(&header[at / 3 * 4], bytes, std::min<std::size_t>(3, 8 - at));
        }
        layout.text("        <DataArray " + attributes + " format=\"binary\">\n" + header);
        block.groups = layout.records(std::int64_t((block.bytes() + 2) / 3), 4);
        layout.text("\n        </DataArray>\n");
        return block;
    };
    layout.text("<?xml version=\"1.0\"?>\n"
                "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                "header_type=\"UInt64\">\n"
                "  <UnstructuredGrid>\n"
                "    <Piece NumberOfPoints=\"" +
                std::to_string(totals.points) + "\" NumberOfCells=\"" + std::to_string(totals.tets) +
                "\">\n"
                "      <Points>\n");
    mPoints = array(std::string("type=\"") + (mFloat32 ? "Float32" : "Float64") +
                        "\" Name=\"Points\" NumberOfComponents=\"3\"",
                    3 * totals.points, mFloat32 ? 4 : 8);
    layout.text("      </Points>\n"
                "      <Cells>\n");
    mConnectivity = array("type=\"Int64\" Name=\"connectivity\"", 4 * totals.tets, 8);
    mOffsets = array("type=\"Int64\" Name=\"offsets\"", totals.tets, 8);
    mTypes = array("type=\"UInt8\" Name=\"types\"", totals.tets, 1);
    layout.text("      </Cells>\n"
                "    </Piece>\n"
                "  </UnstructuredGrid>\n"
                "</VTKFile>\n");
    mLayouts.push_back(std::move(layout));
}

void VtuInline::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    const std::int64_t firstCoordinate = 3 * chunk.firstPoint, firstId = 4 * chunk.firstTet;
    put(file, mPoints, firstCoordinate, 3 * chunk.points.size(), [&](std::int64_t i) -> std::uint64_t {
        const double coordinate = chunk.points[0].asPointer()[i - firstCoordinate];
        return mFloat32 ? bitsOf<std::uint32_t>(float(coordinate)) : bitsOf<std::uint64_t>(coordinate);
    });
    put(file, mConnectivity, firstId, 4 * chunk.tets.size(), [&](std::int64_t i) -> std::uint64_t {
        return i < firstId ? 0 : std::uint64_t(chunk.tets[0].data()[i - firstId]);
    });
    put(file, mOffsets, chunk.firstTet, chunk.tets.size(),
        [](std::int64_t i) { return std::uint64_t(4 * (i + 1)); });
    put(file, mTypes, chunk.firstTet, chunk.tets.size(), [](std::int64_t) { return kVtkTetra; });
}

} // namespace

std::unique_ptr<Format> makeVtuInline(const MeshTotals& totals) {
    return std::make_unique<VtuInline>(totals);
}

} // namespace vdbtet
