/// @file Inp.cc
/// Input files of Abaqus, which other programs read as well: nodes, and linear tets (C3D4) in one element
/// set.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

#include <algorithm>

namespace vdbtet {

namespace {

constexpr std::int64_t kMostIds = 999999999; // "the maximum node number allowed", element numbers alike
constexpr std::size_t kRealWidth = 20;       // "floating point numbers can occupy up to 20 spaces"

class Inp final : public Format {
public:
    explicit Inp(const MeshTotals& totals) {
        requireAtMost(kMostIds, totals.points, "points", "inp");
        requireAtMost(kMostIds, totals.tets, "tets", "inp");
        TextNumbers numbers(totals, 1);
        numbers.realWidth = std::min(numbers.realWidth, kRealWidth);
        RecordLayout& layout = mLayouts.emplace_back();
        layout.text("*HEADING\nTetrahedra of a volume, by vdbtet\n*NODE\n");
        mPoints = TextRows(layout, totals.points, "@, *, *, *\n", numbers);
        layout.text("*ELEMENT, TYPE=C3D4, ELSET=TETS\n");
        mTets = TextRows(layout, totals.tets, "@, #, #, #, #\n", numbers);
    }

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mTets.put(files[0], chunk.firstTet, chunk.tets);
    }

private:
    TextRows mPoints, mTets;
};

} // namespace

std::unique_ptr<Format> makeInp(const MeshTotals& totals) { return std::make_unique<Inp>(totals); }

} // namespace vdbtet
