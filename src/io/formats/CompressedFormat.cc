/// @file CompressedFormat.cc
/// Chunks into blocks.
#include "io/formats/CompressedFormat.h"

namespace vdbtet {

CompressedFormat::CompressedFormat(const MeshTotals& totals, int level)
    : mArrays(vtkArrays(totals)),
      mDeflater(level, [this](const BlockDeflater::Block& block) { put(block); }) {}

void CompressedFormat::write(const MeshChunk& chunk) {
    for (std::size_t a = 0; a < mArrays.size(); ++a) {
        mDeflater.append(a, mArrays[a].runOf(chunk).count,
                         [&](std::size_t i, std::size_t n, char* to) { mArrays[a].encode(chunk, i, n, to); });
    }
}

std::uint64_t CompressedFormat::mostBytes(std::uint64_t bytes, const MeshTotals& totals) {
    // zlib adds 5 bytes to each 16 kB that it cannot compress; to each block of 256 kB an entry of at most 82
    // bytes is added in HDF5's tree of chunks, and to each array a node of that tree.
    const std::size_t arrays = 4 + totals.pointFields.size() + totals.cellFields.size();
    return bytes + bytes / 64 + 4096 * (arrays + 4);
}

} // namespace vdbtet
