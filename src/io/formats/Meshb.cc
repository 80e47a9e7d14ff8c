/// @file Meshb.cc
/// Medit's format, binary: keywords, each with the position of the next one, in front of rows like those of
/// Mesh.cc. Coordinates are float64.
///
/// The version is 2 where positions in the file fit into 32 bits, the last that Mmg reads, else 3, and 4
/// where ids and counts need 64 bits, too.
#include "io/formats/Format.h"

#include <algorithm>
#include <limits>

namespace vdbtet {

namespace {

constexpr std::int64_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();
enum Keyword : std::int32_t { kDimension = 3, kVertices = 4, kTetrahedra = 8, kEnd = 54 };

class Meshb final : public Format {
public:
    Meshb(const MeshTotals& totals, int version);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mInt32;
    std::size_t mIntBytes;
    RecordLayout::Section mPoints, mTets;

    void storeInts(char* to, const std::int64_t* values, std::size_t count) const {
        mInt32 ? storeAs<std::int32_t>(to, values, count) : storeAs<std::int64_t>(to, values, count);
    }
};

Meshb::Meshb(const MeshTotals& totals, int version) : mInt32(version < 4), mIntBytes(mInt32 ? 4 : 8) {
    RecordLayout layout;
    const auto integer = [&layout](bool is32, std::int64_t value) {
        is32 ? layout.binary(static_cast<std::int32_t>(value)) : layout.binary(value);
    };
    const bool position32 = version < 3;
    const auto keyword = [&](Keyword code, std::uint64_t contentBytes) {
        layout.binary(std::int32_t(code));
        const std::uint64_t content = layout.size() + (position32 ? 4 : 8);
        integer(position32, code == kEnd ? 0 : std::int64_t(content + contentBytes));
    };
    const auto rows = [&](Keyword code, std::int64_t count, std::size_t bytesEach) {
        keyword(code, mIntBytes + std::uint64_t(count) * bytesEach);
        integer(mInt32, count);
        return layout.records(count, bytesEach);
    };
    layout.binary(std::int32_t(1)); // tells the byte order
    layout.binary(std::int32_t(version));
    keyword(kDimension, 4);
    layout.binary(std::int32_t(3));
    mPoints = rows(kVertices, totals.points, 3 * 8 + mIntBytes);
    mTets = rows(kTetrahedra, totals.tets, 5 * mIntBytes);
    keyword(kEnd, 0);
    mLayouts.push_back(std::move(layout));
}

void Meshb::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        const std::int64_t reference = 0;
        for (std::size_t k = 0; k < n; ++k, to += mPoints.recordBytes) {
            storeAs<double>(to, chunk.points[i + k].asPointer(), 3);
            storeInts(to + 3 * 8, &reference, 1);
        }
    });
    file.put(mTets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k, to += mTets.recordBytes) {
            const Tet& tet = chunk.tets[i + k];
            const std::int64_t reference = 1;
            const std::int64_t row[] = {tet[0] + 1, tet[1] + 1, tet[2] + 1, tet[3] + 1, reference};
            storeInts(to, row, 5);
        }
    });
}

} // namespace

std::unique_ptr<Format> makeMeshb(const MeshTotals& totals) {
    if (std::max(totals.points, totals.tets) > kMaxInt32) return std::make_unique<Meshb>(totals, 4);
    auto small = std::make_unique<Meshb>(totals, 2);
    if (small->layouts()[0].size() <= std::uint64_t(kMaxInt32)) return small;
    return std::make_unique<Meshb>(totals, 3);
}

} // namespace vdbtet
