/// @file VtuWriter.cc
/// The VTK XML file format with raw appended data: a text header, then four blocks [UInt64 bytes][data], each
/// at an offset known from the totals alone.
#include <vdbtet/VtuWriter.h>

#include <vdbtet/Errors.h>

#include "io/OutputFile.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>

namespace vdbtet {

namespace {

constexpr char kFooter[] = "\n  </AppendedData>\n</VTKFile>\n";
constexpr std::uint8_t kVtkTetra = 10;
/// Bytes converted at a time: enough to make system calls rare, few enough for the cache.
constexpr std::size_t kBatchBytes = std::size_t(1) << 19;

/// Where everything is in the file of a mesh.
struct VtuLayout {
    struct Block {
        std::uint64_t offset = 0; // of the data, after their size
        std::uint64_t bytes = 0;
    };

    explicit VtuLayout(const MeshTotals& totals);

    bool float32;
    bool int32Connectivity;
    bool int32Offsets;
    std::string header;
    Block points, connectivity, offsets, types;
    std::uint64_t end = 0; // of the data
};

VtuLayout::VtuLayout(const MeshTotals& totals) {
    constexpr std::int64_t maxInt32 = std::numeric_limits<std::int32_t>::max();
    float32 = totals.float32Suffices;
    int32Connectivity = totals.points - 1 <= maxInt32;
    int32Offsets = totals.tets <= maxInt32 / 4;

    const auto nPoints = static_cast<std::uint64_t>(totals.points);
    const auto nTets = static_cast<std::uint64_t>(totals.tets);
    points.bytes = nPoints * 3 * (float32 ? 4 : 8);
    connectivity.bytes = nTets * 4 * (int32Connectivity ? 4 : 8);
    offsets.bytes = nTets * (int32Offsets ? 4 : 8);
    types.bytes = nTets;

    std::uint64_t appended = 0;
    for (Block* block : {&points, &connectivity, &offsets, &types}) {
        block->offset = appended + 8;
        appended += 8 + block->bytes;
    }

    const auto array = [](const char* type, const char* name, const char* more, const Block& block) {
        return std::string("        <DataArray type=\"") + type + "\" Name=\"" + name + "\"" + more +
               " format=\"appended\" offset=\"" + std::to_string(block.offset - 8) + "\"/>\n";
    };
    const char* byteOrder = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "BigEndian" : "LittleEndian";
    header = std::string("<?xml version=\"1.0\"?>\n"
                         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
             byteOrder +
             "\" header_type=\"UInt64\">\n"
             "  <UnstructuredGrid>\n"
             "    <Piece NumberOfPoints=\"" +
             std::to_string(totals.points) + "\" NumberOfCells=\"" + std::to_string(totals.tets) +
             "\">\n"
             "      <Points>\n" +
             array(float32 ? "Float32" : "Float64", "Points", " NumberOfComponents=\"3\"", points) +
             "      </Points>\n"
             "      <Cells>\n" +
             array(int32Connectivity ? "Int32" : "Int64", "connectivity", "", connectivity) +
             array(int32Offsets ? "Int32" : "Int64", "offsets", "", offsets) +
             array("UInt8", "types", "", types) +
             "      </Cells>\n"
             "    </Piece>\n"
             "  </UnstructuredGrid>\n"
             "  <AppendedData encoding=\"raw\">\n"
             "_";
    for (Block* block : {&points, &connectivity, &offsets, &types}) block->offset += header.size();
    end = header.size() + appended;
}

} // namespace

struct VtuWriter::Impl {
    explicit Impl(std::string target) : path(std::move(target)), file(path) {}

    /// Write the values [first, first + n) of a block of @a T, where value(i) is the i-th of them.
    template <typename T, typename ValueF>
    void put(const VtuLayout::Block& block, std::int64_t first, std::size_t n, const ValueF& value) {
        std::vector<char>& bytes = batches.local();
        bytes.resize(kBatchBytes);
        T* batch = reinterpret_cast<T*>(bytes.data());
        constexpr std::size_t kBatch = kBatchBytes / sizeof(T);
        auto offset = block.offset + static_cast<std::uint64_t>(first) * sizeof(T);
        for (std::size_t done = 0; done < n; done += kBatch) {
            const std::size_t count = std::min(kBatch, n - done);
            for (std::size_t k = 0; k < count; ++k) batch[k] = static_cast<T>(value(done + k));
            file.writeAt(offset, batch, count * sizeof(T));
            offset += count * sizeof(T);
        }
    }

    template <typename ValueF>
    void putInts(const VtuLayout::Block& block, bool int32, std::int64_t first, std::size_t n,
                 const ValueF& value) {
        int32 ? put<std::int32_t>(block, first, n, value) : put<std::int64_t>(block, first, n, value);
    }

    std::string path;
    OutputFile file;
    MeshTotals totals;
    std::unique_ptr<const VtuLayout> layout;
    tbb::enumerable_thread_specific<std::vector<char>> batches;
    std::atomic<std::int64_t> pointsWritten{0};
    std::atomic<std::int64_t> tetsWritten{0};
};

VtuWriter::VtuWriter(std::string path) : mImpl(std::make_unique<Impl>(std::move(path))) {}

VtuWriter::~VtuWriter() = default;

bool VtuWriter::begin(const MeshTotals& totals) {
    mImpl->totals = totals;
    mImpl->layout = std::make_unique<VtuLayout>(totals);
    const VtuLayout& layout = *mImpl->layout;
    mImpl->file.reserve(fileSize(totals));
    mImpl->file.writeAt(0, layout.header.data(), layout.header.size());
    for (const auto& block : {layout.points, layout.connectivity, layout.offsets, layout.types}) {
        mImpl->file.writeAt(block.offset - 8, &block.bytes, 8);
    }
    mImpl->file.writeAt(layout.end, kFooter, std::strlen(kFooter));
    return true;
}

void VtuWriter::chunk(const MeshChunk& chunk) {
    Impl& impl = *mImpl;
    const VtuLayout& layout = *impl.layout;
    const auto nPoints = chunk.points.size(), nTets = chunk.tets.size();
    if (chunk.firstPoint + static_cast<std::int64_t>(nPoints) > impl.totals.points ||
        chunk.firstTet + static_cast<std::int64_t>(nTets) > impl.totals.tets) {
        throw FileError("cannot write " + impl.path + ": more points or tets than announced");
    }

    const double* xyz = nPoints ? chunk.points[0].asPointer() : nullptr;
    const std::int64_t* ids = nTets ? chunk.tets[0].data() : nullptr;
    const auto coordinate = [xyz](std::size_t i) { return xyz[i]; };
    if (layout.float32) {
        impl.put<float>(layout.points, 3 * chunk.firstPoint, 3 * nPoints, coordinate);
    } else {
        impl.put<double>(layout.points, 3 * chunk.firstPoint, 3 * nPoints, coordinate);
    }
    impl.putInts(layout.connectivity, layout.int32Connectivity, 4 * chunk.firstTet, 4 * nTets,
                 [ids](std::size_t i) { return ids[i]; });
    impl.putInts(layout.offsets, layout.int32Offsets, chunk.firstTet, nTets,
                 [&](std::size_t i) { return 4 * (chunk.firstTet + static_cast<std::int64_t>(i) + 1); });
    impl.put<std::uint8_t>(layout.types, chunk.firstTet, nTets, [](std::size_t) { return kVtkTetra; });
    impl.pointsWritten += static_cast<std::int64_t>(nPoints);
    impl.tetsWritten += static_cast<std::int64_t>(nTets);
}

void VtuWriter::end() {
    if (mImpl->pointsWritten != mImpl->totals.points || mImpl->tetsWritten != mImpl->totals.tets) {
        throw FileError("cannot write " + mImpl->path + ": fewer points or tets than announced");
    }
    mImpl->file.commit();
}

std::uint64_t VtuWriter::fileSize(const MeshTotals& totals) {
    return VtuLayout(totals).end + std::strlen(kFooter);
}

} // namespace vdbtet
