/// @file VtuInline.cc
/// The VTK XML file format with its arrays inline, in base64: valid XML, for readers that refuse Vtu.cc's.
///
/// Three bytes make a group of four characters, and the ids of a tet are no multiple of three bytes, so a
/// chunk may begin with a group whose first one or two bytes are of the tet before. Ids are little-endian
/// Int64 here, and no mesh has 2^48 points: these bytes are zeros. The chunk that has the last byte of a
/// group writes it.
#include "io/formats/Format.h"
#include "io/formats/Names.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

namespace vdbtet {

namespace {

constexpr std::uint64_t kVtkTetra = 10;

/// Encode up to three bytes.
void putGroup(char* to, const std::array<std::uint8_t, 3>& bytes, std::size_t count) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned group = unsigned(bytes[0]) << 16 | unsigned(bytes[1]) << 8 | bytes[2];
    for (std::size_t i = 0; i < 4; ++i) to[i] = i <= count ? kDigits[group >> (18 - 6 * i) & 63] : '=';
}

template <typename Bits, typename T>
Bits bitsOf(T value) {
    Bits bits;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// An array of the file.
struct Block {
    std::uint64_t words = 0;
    std::size_t wordBytes = 0;
    RecordLayout::Section groups;
    std::uint64_t bytes() const { return words * wordBytes; }
};

/// Write groups of an array; @a word(i) is the bits of word i.
template <typename Word>
void putGroups(RecordFile& file, const Block& block, std::uint64_t first, std::uint64_t end,
               const Word& word) {
    file.put(block.groups, std::int64_t(first), end - first, [&](std::size_t done, std::size_t n, char* to) {
        std::uint64_t at = 3 * (first + done);
        for (std::size_t i = 0; i < n; ++i, at += 3) {
            const std::size_t some = std::min<std::uint64_t>(3, block.bytes() - at);
            std::array<std::uint8_t, 3> bytes{};
            for (std::size_t k = 0; k < some; ++k) {
                const std::uint64_t bits = word(std::int64_t((at + k) / block.wordBytes));
                bytes[k] = std::uint8_t(bits >> (8 * ((at + k) % block.wordBytes)));
            }
            putGroup(to + 4 * i, bytes, some);
        }
    });
}

/// The end of the groups that have their last byte before byte @a end.
std::uint64_t groupsBefore(const Block& block, std::uint64_t end) {
    return (end == block.bytes() ? end + 2 : end) / 3;
}

/// Write the words from @a first on; @a word(i) is the bits of word i, or of the one before the first.
template <typename Word>
void put(RecordFile& file, const Block& block, std::int64_t first, std::size_t count, const Word& word) {
    if (count == 0) return;
    const std::uint64_t begin = std::uint64_t(first) * block.wordBytes, end = begin + count * block.wordBytes;
    putGroups(file, block, begin / 3, groupsBefore(block, end), word);
}

/// @brief The array of a field.
/// @details Here nothing is known of the value before a chunk. The groups that two chunks share wait for
/// their other part; the chunk that brings it writes them.
class FieldBlock {
public:
    explicit FieldBlock(const Block& block) : mBlock(block), mShared(std::make_unique<Shared>()) {}

    void put(RecordFile& file, std::int64_t firstRecord, std::size_t records,
             const ArrayView<float>& values) const {
        if (records == 0) return;
        const std::int64_t first = firstRecord * std::int64_t(values.size() / records);
        const auto word = [&](std::int64_t i) {
            return bitsOf<std::uint32_t>(values[std::size_t(i - first)]);
        };
        const std::uint64_t begin = std::uint64_t(first) * 4, end = begin + values.size() * 4;
        putGroups(file, mBlock, (begin + 2) / 3, groupsBefore(mBlock, end), word);
        for (const std::uint64_t at : {begin, end}) {
            if (at % 3 == 0 || at == mBlock.bytes()) continue;
            std::array<std::uint8_t, 3> part{};
            for (std::uint64_t k = 0; k < 3; ++k) {
                const std::uint64_t byte = at / 3 * 3 + k;
                if (byte >= begin && byte < end)
                    part[k] = std::uint8_t(word(std::int64_t(byte / 4)) >> (8 * (byte % 4)));
            }
            putPart(file, at / 3, part);
        }
    }

private:
    using Bytes = std::array<std::uint8_t, 3>;
    struct Shared {
        std::mutex mutex;
        std::map<std::uint64_t, Bytes> parts; ///< by group; the bytes not there yet are 0
    };

    void putPart(RecordFile& file, std::uint64_t group, Bytes part) const {
        {
            const std::lock_guard<std::mutex> lock(mShared->mutex);
            const auto [other, isFirst] = mShared->parts.emplace(group, part);
            if (isFirst) return;
            for (std::size_t k = 0; k < 3; ++k) part[k] |= other->second[k];
            mShared->parts.erase(other);
        }
        file.put(mBlock.groups, std::int64_t(group), 1,
                 [&](std::size_t, std::size_t, char* to) { putGroup(to, part, 3); });
    }

    Block mBlock;
    std::unique_ptr<Shared> mShared;
};

class VtuInline final : public Format {
public:
    explicit VtuInline(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mFloat32;
    Block mPoints, mConnectivity, mOffsets, mTypes;
    FieldPlaces<FieldBlock> mFields;
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
    layout.text("      </Cells>\n");
    const auto data = [&](const std::string& element, const std::vector<MeshField>& fields,
                          std::int64_t records) {
        std::vector<FieldBlock> places;
        if (fields.empty()) return places;
        layout.text("      <" + element + ">\n");
        for (const MeshField& field : fields) {
            // To meshio a scalar that says so is a vector of one component.
            const std::string components =
                field.components == 1 ? ""
                                      : " NumberOfComponents=\"" + std::to_string(field.components) + "\"";
            places.emplace_back(array("type=\"Float32\" Name=\"" + xmlName(field.name) + "\"" + components,
                                      records * field.components, 4));
        }
        layout.text("      </" + element + ">\n");
        return places;
    };
    mFields.points = data("PointData", totals.pointFields, totals.points);
    mFields.cells = data("CellData", totals.cellFields, totals.tets);
    layout.text("    </Piece>\n"
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
    mFields.forEach(chunk,
                    [&file](const FieldBlock& block, std::int64_t first, std::size_t count,
                            const ArrayView<float>& values) { block.put(file, first, count, values); });
}

} // namespace

std::unique_ptr<Format> makeVtuInline(const MeshTotals& totals) {
    return std::make_unique<VtuInline>(totals);
}

} // namespace vdbtet
