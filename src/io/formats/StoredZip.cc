/// @file StoredZip.cc
/// The headers of the zip format (APPNOTE.TXT of PKWARE, 4.3 and 4.5.3).
#include "io/formats/StoredZip.h"

#include <zlib.h>

namespace vdbtet {

namespace {

constexpr std::uint64_t kSee64 = 0xffffffff; // the number is in the zip64 field
constexpr std::uint64_t kVersion = 45;       // the first that knows zip64

static_assert(sizeof(z_off_t) >= 8, "files of more than 2 GB");

/// What a local header and one of the directory have in common before the checksum.
std::string startOfHeader() {
    return littleEndian({{kVersion, 2}, {0, 2}, {0, 2}, {0, 2}, {0x21, 2}}); // stored, 1980-01-01 00:00
}

} // namespace

StoredZip::Entry& StoredZip::append(RecordLayout& layout, const std::string& name, const std::string& text,
                                    std::int64_t count, std::size_t bytesEach) {
    Entry& entry = mEntries.emplace_back();
    const std::uint64_t recordsBytes = std::uint64_t(count) * bytesEach;
    entry.name = name;
    entry.offset = layout.size();
    entry.bytes = text.size() + recordsBytes;
    entry.count = count;
    layout.text("PK\3\4" + startOfHeader());
    entry.crcPlaces[0] = layout.records(1, 4);
    layout.text(littleEndian({{kSee64, 4}, {kSee64, 4}, {name.size(), 2}, {20, 2}}) + name +
                littleEndian({{1, 2}, {16, 2}, {entry.bytes, 8}, {entry.bytes, 8}}) + text);
    entry.records = layout.records(count, bytesEach);
    entry.textCrc = crcOf(text.data(), text.size(), recordsBytes);
    return entry;
}

void StoredZip::appendDirectory(RecordLayout& layout) {
    const std::uint64_t start = layout.size(), count = mEntries.size();
    for (Entry& entry : mEntries) {
        layout.text("PK\1\2" + littleEndian({{kVersion, 2}}) + startOfHeader());
        entry.crcPlaces[1] = layout.records(1, 4);
        layout.text(littleEndian({{kSee64, 4}, {kSee64, 4}, {entry.name.size(), 2}, {28, 2}}) +
                    littleEndian({{0, 2}, {0, 2}, {0, 6}, {kSee64, 4}}) + // no comment, disk 0, no attributes
                    entry.name +
                    littleEndian({{1, 2}, {24, 2}, {entry.bytes, 8}, {entry.bytes, 8}, {entry.offset, 8}}));
    }
    const std::uint64_t end = layout.size(), size = end - start;
    layout.text("PK\6\6" + littleEndian({{44, 8}, {kVersion, 2}, {kVersion, 2}, {0, 4}, {0, 4}}) +
                littleEndian({{count, 8}, {count, 8}, {size, 8}, {start, 8}}));
    layout.text("PK\6\7" + littleEndian({{0, 4}, {end, 8}, {1, 4}}));
    layout.text("PK\5\6" +
                littleEndian({{0, 2}, {0, 2}, {count, 2}, {count, 2}, {size, 4}, {kSee64, 4}, {0, 2}}));
}

std::uint32_t StoredZip::crcOf(const char* part, std::size_t bytes, std::uint64_t bytesAfter) {
    // The checksum is linear: each part adds its own, moved on by as many bytes as come after it.
    const uLong own = crc32_z(0, reinterpret_cast<const Bytef*>(part), bytes);
    return static_cast<std::uint32_t>(crc32_combine(own, 0, static_cast<z_off_t>(bytesAfter)));
}

std::vector<std::uint32_t> StoredZip::crcs() const {
    std::vector<std::uint32_t> all;
    for (const Entry& entry : mEntries) all.push_back(entry.crc);
    return all;
}

void StoredZip::writeCrcs(RecordFile& file, const std::vector<std::uint32_t>& crcs) const {
    auto next = crcs.begin();
    for (const Entry& entry : mEntries) {
        const std::string crc = littleEndian({{entry.textCrc ^ *next++, 4}});
        for (const auto& place : entry.crcPlaces) {
            file.put(place, 0, 1, [&crc](std::size_t, std::size_t, char* to) { crc.copy(to, crc.size()); });
        }
    }
}

std::string littleEndian(std::initializer_list<std::pair<std::uint64_t, int>> valuesAndBytes) {
    std::string text;
    for (const auto& [value, bytes] : valuesAndBytes) {
        for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i));
    }
    return text;
}

} // namespace vdbtet
