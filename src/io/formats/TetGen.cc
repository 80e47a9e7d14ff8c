/// @file TetGen.cc
/// The three text files of TetGen: .node, .ele, .face. Ids start at 1, which Chrono insists on; a tet's
/// corners are in the order that TetGen itself writes, which is ours.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

namespace vdbtet {

namespace {

class TetGen final : public Format {
public:
    explicit TetGen(const MeshTotals& totals) {
        const TextNumbers numbers(totals, 1);
        mWantsTriangles = true;
        mLayouts.resize(3);
        RecordLayout &node = mLayouts[0], &ele = mLayouts[1], &face = mLayouts[2];
        node.text(std::to_string(totals.points) + " 3 0 0\n"); // dimension, attributes, markers
        mPoints = TextRows(node, totals.points, "@ * * *\n", numbers);
        ele.text(std::to_string(totals.tets) + " 4 0\n"); // corners, attributes
        mTets = TextRows(ele, totals.tets, "@ # # # #\n", numbers);
        face.text(std::to_string(totals.triangles) + " 1\n"); // markers
        mTriangles = TextRows(face, totals.triangles, "@ # # # 1\n", numbers);
    }

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mTets.put(files[1], chunk.firstTet, chunk.tets);
        mTriangles.put(files[2], chunk.firstTriangle, chunk.triangles);
    }

private:
    TextRows mPoints, mTets, mTriangles;
};

} // namespace

std::unique_ptr<Format> makeTetGen(const MeshTotals& totals) { return std::make_unique<TetGen>(totals); }

} // namespace vdbtet
