/// @file SurfaceFile.cc
/// Collects the boundary, then writes it from the front to the back.
#include <vdbtet/SurfaceFile.h>

#include <vdbtet/Errors.h>

#include "io/OutputFile.h"
#include "io/SplitFans.h"

#include <tbb/concurrent_vector.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

/// The boundary of a chunk.
struct Piece {
    std::int64_t firstPoint;
    std::vector<std::int64_t> ids; ///< of the points
    std::vector<Vec3d> points;
    std::vector<Triangle> triangles;
};

/// The whole boundary, its triangles' corners being numbers of its points.
struct Surface {
    std::vector<Vec3d> points;
    std::vector<Triangle> triangles;
    bool float32;
};

/// Collects bytes, and passes them on in large pieces.
class Stream {
public:
    explicit Stream(OutputFile& file) : mFile(file) {}

    void bytes(const void* data, std::size_t size) {
        const char* from = static_cast<const char*>(data);
        mBuffer.insert(mBuffer.end(), from, from + size);
        if (mBuffer.size() >= kPiece) flush();
    }
    void text(const std::string& text) { bytes(text.data(), text.size()); }
    template <typename T>
    void binary(T value) {
        bytes(&value, sizeof value);
    }
    template <typename T>
    void number(T value) {
        char digits[32];
        bytes(digits, std::size_t(std::to_chars(digits, digits + sizeof digits, value).ptr - digits));
    }
    void flush() {
        mFile.writeAt(mOffset, mBuffer.data(), mBuffer.size());
        mOffset += mBuffer.size();
        mBuffer.clear();
    }

private:
    static constexpr std::size_t kPiece = std::size_t(1) << 20;

    OutputFile& mFile;
    std::vector<char> mBuffer;
    std::uint64_t mOffset = 0;
};

void writeObj(const Surface& surface, Stream& to) {
    for (const Vec3d& point : surface.points) {
        to.text("v");
        for (int i = 0; i < 3; ++i) {
            to.text(" ");
            surface.float32 ? to.number(float(point[i])) : to.number(point[i]);
        }
        to.text("\n");
    }
    for (const Triangle& triangle : surface.triangles) {
        to.text("f");
        for (const std::int64_t corner : triangle) {
            to.text(" ");
            to.number(corner + 1);
        }
        to.text("\n");
    }
}

void writePly(const Surface& surface, Stream& to) {
    const std::string real = surface.float32 ? "float" : "double";
    std::string header = std::string("ply\nformat binary_") +
                         (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "big" : "little") +
                         "_endian 1.0\nelement vertex " + std::to_string(surface.points.size()) + "\n";
    for (const char* axis : {"x", "y", "z"}) header += "property " + real + " " + axis + "\n";
    header += "element face " + std::to_string(surface.triangles.size()) +
              "\nproperty list uchar int vertex_indices\nend_header\n";
    to.text(header);
    for (const Vec3d& point : surface.points) {
        for (int i = 0; i < 3; ++i) surface.float32 ? to.binary(float(point[i])) : to.binary(point[i]);
    }
    for (const Triangle& triangle : surface.triangles) {
        to.binary(std::uint8_t(3));
        for (const std::int64_t corner : triangle) to.binary(std::int32_t(corner));
    }
}

void writeStl(const Surface& surface, Stream& to) {
    char header[80] = "binary STL of a boundary"; // must not begin with "solid"
    to.bytes(header, sizeof header);
    to.binary(std::uint32_t(surface.triangles.size()));
    for (const Triangle& triangle : surface.triangles) {
        const Vec3d& a = surface.points[std::size_t(triangle[0])];
        const Vec3d& b = surface.points[std::size_t(triangle[1])];
        const Vec3d& c = surface.points[std::size_t(triangle[2])];
        Vec3d normal = (b - a).cross(c - a);
        normal.normalize(0.0);
        for (const Vec3d& vector : {normal, a, b, c}) {
            for (int i = 0; i < 3; ++i) to.binary(float(vector[i]));
        }
        to.binary(std::uint16_t(0));
    }
}

using Write = void (*)(const Surface&, Stream&);

Write writerFor(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension == ".obj") return writeObj;
    if (extension == ".ply") return writePly;
    if (extension == ".stl") return writeStl;
    throw BadOption("cannot tell the format of the surface " + path + ": there are .obj, .ply and .stl");
}

} // namespace

struct SurfaceFile::Impl {
    Impl(const std::string& path, bool splits) : write(writerFor(path)), file(path), splitsFans(splits) {}

    Surface collect();

    Write write;
    OutputFile file;
    bool splitsFans;
    std::int64_t split = 0;
    MeshTotals totals;
    tbb::concurrent_vector<Piece> pieces;
};

/// Put the pieces in order, and leave out points that no triangle uses.
Surface SurfaceFile::Impl::collect() {
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece& a, const Piece& b) { return a.firstPoint < b.firstPoint; });
    Surface surface;
    surface.float32 = totals.float32Suffices;
    std::vector<std::int64_t> ids;
    for (const Piece& piece : pieces) {
        ids.insert(ids.end(), piece.ids.begin(), piece.ids.end());
        surface.points.insert(surface.points.end(), piece.points.begin(), piece.points.end());
        surface.triangles.insert(surface.triangles.end(), piece.triangles.begin(), piece.triangles.end());
    }
    pieces.clear();

    std::vector<std::int64_t> numbers(ids.size(), 0); // first whether a point is used
    for (Triangle& triangle : surface.triangles) {
        for (std::int64_t& corner : triangle) {
            corner = std::lower_bound(ids.begin(), ids.end(), corner) - ids.begin();
            numbers[std::size_t(corner)] = 1;
        }
    }
    std::int64_t count = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] == 0) continue;
        surface.points[std::size_t(count)] = surface.points[i];
        numbers[i] = count++;
    }
    surface.points.resize(std::size_t(count));
    for (Triangle& triangle : surface.triangles) {
        for (std::int64_t& corner : triangle) corner = numbers[std::size_t(corner)];
    }
    return surface;
}

SurfaceFile::SurfaceFile(const std::string& path, bool splitsFans)
    : mImpl(std::make_unique<Impl>(path, splitsFans)) {}

SurfaceFile::~SurfaceFile() = default;

bool SurfaceFile::begin(const MeshTotals& totals) {
    // Twice as many triangles as points; all three formats count in 32 bits, or their readers do.
    if (totals.triangles > std::numeric_limits<std::int32_t>::max())
        throw TooLarge("the boundary has more triangles than surface files can count");
    mImpl->totals = totals;
    mImpl->pieces.clear();
    return true;
}

void SurfaceFile::chunk(const MeshChunk& chunk) {
    if (chunk.surfacePoints.empty()) return;
    Piece piece;
    piece.firstPoint = chunk.firstPoint;
    piece.ids.assign(chunk.surfacePoints.begin(), chunk.surfacePoints.end());
    piece.points.reserve(piece.ids.size());
    for (const std::int64_t id : piece.ids)
        piece.points.push_back(chunk.points[std::size_t(id - chunk.firstPoint)]);
    piece.triangles.assign(chunk.triangles.begin(), chunk.triangles.end());
    mImpl->pieces.push_back(std::move(piece));
}

void SurfaceFile::end() {
    Surface surface = mImpl->collect();
    if (mImpl->splitsFans) mImpl->split = splitFans(surface.points, surface.triangles);
    Stream stream(mImpl->file);
    mImpl->write(surface, stream);
    stream.flush();
    mImpl->file.commit();
}

std::int64_t SurfaceFile::split() const { return mImpl->split; }

} // namespace vdbtet
