/// @file BlockDeflater.cc
/// Batches of blocks, in parallel.
#include "io/BlockDeflater.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <zlib.h>

#include <cstring>
#include <new>
#include <utility>

namespace vdbtet {

namespace {

/// Enough that threads seldom wait for the slowest block; 2 x 16 MiB.
constexpr std::size_t kBlocksABatch = 64;

/// All first bytes of the numbers, then all second ones: HDF5's filter of that name.
std::vector<char> shuffledBytes(const std::vector<char>& bytes, std::size_t numberBytes) {
    std::vector<char> result(bytes.size());
    const std::size_t numbers = bytes.size() / numberBytes;
    for (std::size_t k = 0; k < numberBytes; ++k) {
        for (std::size_t i = 0; i < numbers; ++i) result[k * numbers + i] = bytes[i * numberBytes + k];
    }
    return result;
}

void deflateBlock(BlockDeflater::Block& block, std::size_t shuffled, int level) {
    if (shuffled > 1) block.raw = shuffledBytes(block.raw, shuffled);
    uLongf size = compressBound(uLong(block.raw.size()));
    block.deflated.resize(size);
    // There is room enough, and the level is valid: only memory can be missing.
    if (compress2(reinterpret_cast<Bytef*>(block.deflated.data()), &size,
                  reinterpret_cast<const Bytef*>(block.raw.data()), uLong(block.raw.size()), level) != Z_OK) {
        throw std::bad_alloc();
    }
    block.deflatedBytes = size;
}

} // namespace

BlockDeflater::BlockDeflater(int level, std::function<void(const Block&)> take)
    : mLevel(level), mTake(std::move(take)) {}

void BlockDeflater::finish() {
    for (std::size_t i = 0; i < mArrays.size(); ++i) {
        Array& array = mArrays[i];
        if (array.filled == 0) continue;
        const std::size_t bytes = array.filled * array.shape.recordBytes;
        std::fill(array.open.begin() + std::ptrdiff_t(bytes), array.open.end(), '\0');
        if (!array.shape.padded) array.open.resize(bytes);
        close(i);
    }
    flush();
}

void BlockDeflater::close(std::size_t array) {
    if (mCount == mFull.size()) mFull.emplace_back();
    Block& block = mFull[mCount++];
    Array& from = mArrays[array];
    block.array = array;
    block.firstRecord = from.first;
    std::swap(block.raw, from.open);
    from.open.resize(from.shape.blockRecords * from.shape.recordBytes);
    from.first += from.filled;
    from.filled = 0;
    if (mCount == kBlocksABatch) flush();
}

void BlockDeflater::flush() {
    // Isolated, lest a thread that waits here takes up the making of another chunk.
    tbb::this_task_arena::isolate([&] {
        const auto one = [&](std::size_t i) {
            deflateBlock(mFull[i], mArrays[mFull[i].array].shape.shuffled, mLevel);
        };
        tbb::parallel_for(std::size_t(0), mCount, one, tbb::simple_partitioner());
    });
    for (std::size_t i = 0; i < mCount; ++i) mTake(mFull[i]);
    mCount = 0;
}

} // namespace vdbtet
