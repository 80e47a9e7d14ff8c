/// @file StoredZip.h
/// Zip archives of uncompressed entries of records, written in any order.
#pragma once

#include "io/RecordFile.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace vdbtet {

/// @brief Lays an archive out, and keeps the checksums of its entries.
/// @details These are known last of all, when the entries are written; they have their places like records.
/// Always zip64, whatever the size.
class StoredZip {
public:
    struct Entry {
        std::string name;
        std::uint64_t offset = 0; ///< of its local header
        std::uint64_t bytes = 0;
        std::int64_t count = 0; ///< of the records
        RecordLayout::Section records;
        std::array<RecordLayout::Section, 2> crcPlaces; ///< local header, directory
        std::uint32_t textCrc = 0;
        std::atomic<std::uint32_t> crc{0}; ///< of the records written
    };

    /// An entry of a text and records behind it.
    Entry& append(RecordLayout& layout, const std::string& name, const std::string& text, std::int64_t count,
                  std::size_t bytesEach);
    /// After the last entry.
    void appendDirectory(RecordLayout& layout);

    /// As RecordFile::put().
    template <typename Encode>
    static void put(RecordFile& file, Entry& entry, std::int64_t first, std::size_t count,
                    const Encode& encode) {
        file.put(entry.records, first, count, [&](std::size_t i, std::size_t n, char* to) {
            encode(i, n, to);
            const auto after = std::uint64_t(entry.count - first) - (i + n);
            const std::size_t bytesEach = entry.records.recordBytes;
            entry.crc ^= crcOf(to, n * bytesEach, after * bytesEach);
        });
    }

    /// @return of each entry, the checksum of the records written, the others taken to be zero bits: so
    /// those of parts, XORed, are that of the whole
    std::vector<std::uint32_t> crcs() const;
    /// @param crcs  of each entry, that of all its records
    void writeCrcs(RecordFile& file, const std::vector<std::uint32_t>& crcs) const;

private:
    static std::uint32_t crcOf(const char* part, std::size_t bytes, std::uint64_t bytesAfter);

    std::deque<Entry> mEntries;
};

/// The texts of numbers, least significant byte first, one behind the other.
std::string littleEndian(std::initializer_list<std::pair<std::uint64_t, int>> valuesAndBytes);

} // namespace vdbtet
