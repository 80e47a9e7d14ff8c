/// @file CompressedFormat.h
/// What a mesh looks like in a compressed file: where everything is, and how large the file, shows only when
/// it is written.
#pragma once

#include "io/BlockDeflater.h"
#include "io/OutputFile.h"
#include "io/formats/VtkArrays.h"

#include <vdbtet/MeshSink.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace vdbtet {

class CompressedFormat {
public:
    virtual ~CompressedFormat() = default;

    /// Chunks come one at a time, and in order.
    void write(const MeshChunk& chunk);

    /// After the last chunk.
    /// @return the size of the file
    virtual std::uint64_t finish() = 0;

    /// @return what a file takes at most that would take @a bytes without compression
    static std::uint64_t mostBytes(std::uint64_t bytes, const MeshTotals& totals);

protected:
    CompressedFormat(const MeshTotals& totals, int level);
    /// Write a block of an array; in the order of its blocks.
    virtual void put(const BlockDeflater::Block& block) = 0;

    std::vector<VtkArray> mArrays;
    BlockDeflater mDeflater; ///< of the same arrays; told their shapes by who derives from this
};

/// @param level  of zlib, 1 to 9
using MakeCompressed = std::unique_ptr<CompressedFormat> (*)(OutputFile& file, const MeshTotals& totals,
                                                             int level);

std::unique_ptr<CompressedFormat> makeVtkHdfCompressed(OutputFile& file, const MeshTotals& totals, int level);
std::unique_ptr<CompressedFormat> makeVtuCompressed(OutputFile& file, const MeshTotals& totals, int level);

} // namespace vdbtet
