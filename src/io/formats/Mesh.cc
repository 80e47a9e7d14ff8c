/// @file Mesh.cc
/// Medit's format, as text: points "x y z reference" and tets "a b c d reference", counted from 1. The
/// version tells the type of the numbers: 1 is float32 and 2 is float64; 4 has 64-bit ids, too.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

#include <algorithm>
#include <limits>

namespace vdbtet {

namespace {

class Mesh final : public Format {
public:
    explicit Mesh(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mTets.put(files[0], chunk.firstTet, chunk.tets);
    }

private:
    TextRows mPoints, mTets;
};

Mesh::Mesh(const MeshTotals& totals) {
    const TextNumbers numbers(totals, 1);
    const bool ids64 = std::max(totals.points, totals.tets) > std::numeric_limits<std::int32_t>::max();
    const char* version = ids64 ? "4" : numbers.float32 ? "1" : "2";
    RecordLayout layout;
    layout.text(std::string("MeshVersionFormatted ") + version + "\nDimension 3\nVertices\n" +
                std::to_string(totals.points) + "\n");
    mPoints = TextRows(layout, totals.points, "* * * 0\n", numbers);
    layout.text("Tetrahedra\n" + std::to_string(totals.tets) + "\n");
    mTets = TextRows(layout, totals.tets, "# # # # 1\n", numbers);
    layout.text("End\n");
    mLayouts.push_back(std::move(layout));
}

} // namespace

std::unique_ptr<Format> makeMesh(const MeshTotals& totals) { return std::make_unique<Mesh>(totals); }

} // namespace vdbtet
