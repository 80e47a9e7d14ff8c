/// @file BlockDeflater.h
/// Cuts arrays into blocks and compresses them, many at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vdbtet {

/// @brief Compresses arrays that grow from the front, side by side, by zlib.
/// @details Blocks hold a fixed number of records, and come out in the order in which they were filled: so
/// the same arrays in the same runs give the same bytes, for any number of threads.
class BlockDeflater {
public:
    struct Block {
        std::size_t array;
        std::uint64_t firstRecord;
        std::vector<char> raw, deflated; ///< of these bytes
        std::size_t deflatedBytes;
    };

    /// No block has more bytes than this before it is compressed.
    static constexpr std::size_t kBlockBytes = std::size_t(1) << 18;

    /// @param level  1 to 9, the higher the smaller and slower
    /// @param take   gets the blocks one at a time
    BlockDeflater(int level, std::function<void(const Block&)> take);

    /// An array, of which blocks call the first one 0.
    struct Shape {
        std::size_t recordBytes;
        std::size_t blockRecords;
        /// The length of numbers, to have all their first bytes first, then all second ones.
        std::size_t shuffled = 1;
        bool padded = false; ///< fill the last block up with zeros
    };
    void addArray(const Shape& shape) { mArrays.push_back({shape, {}}); }

    /// As RecordFile::put().
    template <typename Encode>
    void append(std::size_t array, std::size_t count, const Encode& encode) {
        for (std::size_t done = 0; done < count;) {
            Array& to = mArrays[array];
            const Shape& shape = to.shape;
            if (to.open.empty()) to.open.resize(shape.blockRecords * shape.recordBytes);
            const std::size_t some = std::min(count - done, shape.blockRecords - to.filled);
            encode(done, some, to.open.data() + to.filled * shape.recordBytes);
            done += some;
            to.filled += some;
            if (to.filled == shape.blockRecords) close(array);
        }
    }

    /// After the last record.
    void finish();

private:
    struct Array {
        Shape shape;
        std::vector<char> open;  ///< the block that is being filled
        std::size_t filled = 0;  ///< records of it
        std::uint64_t first = 0; ///< record of it
    };

    void close(std::size_t array);
    void flush();

    int mLevel;
    std::function<void(const Block&)> mTake;
    std::vector<Array> mArrays;
    std::vector<Block> mFull; ///< memory that is kept; the first mCount wait to be compressed
    std::size_t mCount = 0;
};

} // namespace vdbtet
