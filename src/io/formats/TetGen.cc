/// @file TetGen.cc
/// The three text files of TetGen: .node, .ele, .face. Ids start at 1, which Chrono insists on; a tet's
/// corners are in the order that TetGen itself writes, which is ours. Fields are attributes, one a component
/// and without names.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

namespace vdbtet {

namespace {

int componentsOf(const std::vector<MeshField>& fields) {
    int components = 0;
    for (const MeshField& field : fields) components += field.components;
    return components;
}

/// The rest of a row's pattern.
std::string columns(int components) {
    std::string pattern;
    for (int i = 0; i < components; ++i) pattern += " ~";
    return pattern + "\n";
}

class TetGen final : public Format {
public:
    explicit TetGen(const MeshTotals& totals) {
        const TextNumbers numbers(totals, 1);
        mWantsTriangles = true;
        mLayouts.resize(3);
        RecordLayout &node = mLayouts[0], &ele = mLayouts[1], &face = mLayouts[2];
        const int ofPoints = componentsOf(totals.pointFields), ofTets = componentsOf(totals.cellFields);
        // Dimension, attributes, markers.
        node.text(std::to_string(totals.points) + " 3 " + std::to_string(ofPoints) + " 0\n");
        mPoints = TextRows(node, totals.points, "@ * * *" + columns(ofPoints), numbers);
        // Corners, attributes.
        ele.text(std::to_string(totals.tets) + " 4 " + std::to_string(ofTets) + "\n");
        mTets = TextRows(ele, totals.tets, "@ # # # #" + columns(ofTets), numbers);
        face.text(std::to_string(totals.triangles) + " 1\n"); // markers
        mTriangles = TextRows(face, totals.triangles, "@ # # # 1\n", numbers);
    }

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points, chunk.pointFields);
        mTets.put(files[1], chunk.firstTet, chunk.tets, chunk.cellFields);
        mTriangles.put(files[2], chunk.firstTriangle, chunk.triangles);
    }

private:
    TextRows mPoints, mTets, mTriangles;
};

} // namespace

std::unique_ptr<Format> makeTetGen(const MeshTotals& totals) { return std::make_unique<TetGen>(totals); }

} // namespace vdbtet
