/// @file Mesh.cc
/// Medit's format, as text: points "x y z reference" and tets "a b c d reference", counted from 1. The
/// version tells the type of the numbers: 1 is float32 and 2 is float64; 4 has 64-bit ids, too.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

#include <algorithm>
#include <limits>

namespace vdbtet {

namespace {

/// Of points, none; of tets, the one material.
constexpr char kPointEnd[] = " 0\n", kTetEnd[] = " 1\n";
constexpr std::size_t kEndBytes = sizeof kTetEnd - 1;

char* putEnd(char* to, const char* end) {
    std::memcpy(to, end, kEndBytes);
    return to + kEndBytes;
}

class Mesh final : public Format {
public:
    explicit Mesh(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    bool mFloat32;
    std::size_t mIdWidth;
    RecordLayout::Section mPoints, mTets;
};

Mesh::Mesh(const MeshTotals& totals) : mFloat32(totals.float32Suffices), mIdWidth(idWidth(totals.points)) {
    const bool ids64 = std::max(totals.points, totals.tets) > std::numeric_limits<std::int32_t>::max();
    const char* version = ids64 ? "4" : mFloat32 ? "1" : "2";
    RecordLayout layout;
    layout.text(std::string("MeshVersionFormatted ") + version + "\nDimension 3\nVertices\n" +
                std::to_string(totals.points) + "\n");
    mPoints = layout.records(totals.points, 3 * (coordinateWidth(mFloat32) + 1) - 1 + kEndBytes);
    layout.text("Tetrahedra\n" + std::to_string(totals.tets) + "\n");
    mTets = layout.records(totals.tets, 4 * (mIdWidth + 1) - 1 + kEndBytes);
    layout.text("End\n");
    mLayouts.push_back(std::move(layout));
}

void Mesh::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                if (axis > 0) *to++ = ' ';
                to = putCoordinate(to, chunk.points[i + k][axis], mFloat32);
            }
            to = putEnd(to, kPointEnd);
        }
    });
    file.put(mTets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k) {
            for (int corner = 0; corner < 4; ++corner) {
                if (corner > 0) *to++ = ' ';
                to = putId(to, chunk.tets[i + k][std::size_t(corner)] + 1, mIdWidth);
            }
            to = putEnd(to, kTetEnd);
        }
    });
}

} // namespace

std::unique_ptr<Format> makeMesh(const MeshTotals& totals) { return std::make_unique<Mesh>(totals); }

} // namespace vdbtet
