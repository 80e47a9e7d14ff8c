/// @file RecordFile.h
/// Files of texts and of arrays of records, each at a place that is known before the first record: so that
/// any thread may write any chunk at any time, and the size of the file is known before the work.
///
/// Formats of text are such files, too, if their numbers are padded to one width.
#pragma once

#include "io/OutputFile.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vdbtet {

/// Where everything is in a file; built from the front to the back.
class RecordLayout {
public:
    struct Section {
        std::uint64_t offset = 0;
        std::size_t recordBytes = 0;
    };

    RecordLayout() = default;
    /// A layout that another library made: what it has written, by offset.
    RecordLayout(std::vector<std::pair<std::uint64_t, std::string>> texts, std::uint64_t size)
        : mTexts(std::move(texts)), mSize(size) {}

    void text(std::string text);

    /// A number as the machine has it in memory.
    template <typename T>
    void binary(const T& value) {
        text(std::string(reinterpret_cast<const char*>(&value), sizeof value));
    }

    Section records(std::int64_t count, std::size_t bytesEach);

    std::uint64_t size() const { return mSize; }

private:
    friend class RecordFile;

    std::vector<std::pair<std::uint64_t, std::string>> mTexts; ///< by offset
    std::uint64_t mSize = 0;
};

class RecordFile {
public:
    /// As OutputFile's.
    template <typename... How>
    explicit RecordFile(const std::string& path, const How&... how) : mFile(path, how...) {}

    /// Take the disk space, and write the texts.
    void start(const RecordLayout& layout);

    /// @brief Write @a count records, starting with the section's record @a first.
    /// @param encode  encode(i, n, bytes) makes the records first + i to first + i + n; of few at a time
    template <typename Encode>
    void put(const RecordLayout::Section& section, std::int64_t first, std::size_t count,
             const Encode& encode) {
        if (count == 0) return;
        std::vector<char>& bytes = mBatches.local();
        bytes.resize(kBatchBytes);
        const std::size_t most = kBatchBytes / section.recordBytes;
        std::uint64_t offset = section.offset + std::uint64_t(first) * section.recordBytes;
        for (std::size_t done = 0; done < count; done += most) {
            const std::size_t some = std::min(most, count - done);
            encode(done, some, bytes.data());
            mFile.writeAt(offset, bytes.data(), some * section.recordBytes);
            offset += some * section.recordBytes;
        }
    }

    void prepare() { mFile.prepare(); }
    void commit() { mFile.commit(); }

    /// For what is not made of records.
    OutputFile& file() { return mFile; }

private:
    /// Enough to make system calls rare, few enough for the cache.
    static constexpr std::size_t kBatchBytes = std::size_t(1) << 19;

    OutputFile mFile;
    tbb::enumerable_thread_specific<std::vector<char>> mBatches;
};

} // namespace vdbtet
