/// @file VtkHdfCompressed.cc
/// VTKHDF with arrays in chunks, shuffled and deflated. The HDF5 library writes them where it likes and keeps
/// the index of them, which grows by some 80 bytes a chunk.
#include "io/formats/CompressedFormat.h"
#include "io/formats/VtkHdfSchema.h"

#include <cstring>

namespace vdbtet {

namespace {

/// Passes all on to the temporary file.
class FileStorage final : public Hdf5Storage {
public:
    explicit FileStorage(OutputFile& file) : mFile(file) {}
    void write(std::uint64_t offset, const void* data, std::size_t size) override {
        mFile.writeAt(offset, data, size);
    }
    void read(std::uint64_t offset, void* data, std::size_t size) override {
        mFile.readAt(offset, data, size);
    }

private:
    OutputFile& mFile;
};

class VtkHdfCompressed final : public CompressedFormat {
public:
    VtkHdfCompressed(OutputFile& file, const MeshTotals& totals, int level);

    std::uint64_t finish() override;

private:
    void put(const BlockDeflater::Block& block) override;

    FileStorage mStorage;
    Hdf5File mFile;
    std::vector<VtkHdfArray> mAdded;
};

VtkHdfCompressed::VtkHdfCompressed(OutputFile& file, const MeshTotals& totals, int level)
    : CompressedFormat(totals, level), mStorage(file), mFile(mStorage, file.path()),
      mAdded(addVtkHdf(mFile, totals, BlockDeflater::kBlockBytes)) {
    for (const VtkHdfArray& added : mAdded) {
        const std::size_t recordBytes = added.array.recordBytes();
        mDeflater.addArray({recordBytes, std::size_t(added.shape.chunkRows / added.rowsARecord()),
                            added.shape.shuffled ? bytesOf(added.array.type) : 1, true});
    }
    // The first tet starts at 0; what follows is where tets end.
    constexpr auto kOffsets = std::size_t(VtkArray::Role::Offsets);
    mDeflater.append(kOffsets, 1, [&](std::size_t, std::size_t, char* to) {
        std::memset(to, 0, mArrays[kOffsets].recordBytes());
    });
}

void VtkHdfCompressed::put(const BlockDeflater::Block& block) {
    const VtkHdfArray& to = mAdded[block.array];
    mFile.writeChunk(to.id, to.shape, block.firstRecord * to.rowsARecord(), block.deflated.data(),
                     block.deflatedBytes);
}

std::uint64_t VtkHdfCompressed::finish() {
    mDeflater.finish();
    return mFile.close();
}

} // namespace

std::unique_ptr<CompressedFormat> makeVtkHdfCompressed(OutputFile& file, const MeshTotals& totals,
                                                       int level) {
    return std::make_unique<VtkHdfCompressed>(file, totals, level);
}

} // namespace vdbtet
