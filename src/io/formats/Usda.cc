/// @file Usda.cc
/// OpenUSD as text: a prim of the schema TetMesh (USD 24.03).
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

#include <limits>

namespace vdbtet {

namespace {

class Usda final : public Format {
public:
    explicit Usda(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mTets.put(files[0], chunk.firstTet, chunk.tets);
        mTriangles.put(files[0], chunk.firstTriangle, chunk.triangles);
    }

private:
    TextRows mPoints, mTets, mTriangles;
};

template <typename Real>
std::string tuple(const openvdb::Vec3d& p) {
    return "(" + shortest(Real(p.x())) + ", " + shortest(Real(p.y())) + ", " + shortest(Real(p.z())) + ")";
}

Usda::Usda(const MeshTotals& totals) {
    requireAtMost(std::int64_t(std::numeric_limits<std::int32_t>::max()) + 1, totals.points, "points",
                  "usda");
    mWantsTriangles = true;
    TextNumbers numbers(totals, 0);
    std::string place;
    if (!numbers.float32) {
        // The schema knows no points but of float32. They are finest around the origin; a prim's place is of
        // float64.
        numbers.useFloat32(true);
        numbers.origin = totals.bounds.getCenter();
        place = "    double3 xformOp:translate = " + tuple<double>(numbers.origin) +
                "\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
    }
    RecordLayout& layout = mLayouts.emplace_back();
    layout.text("#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
                "def TetMesh \"mesh\"\n{\n    float3[] extent = [" +
                tuple<float>(totals.bounds.min() - numbers.origin) + ", " +
                tuple<float>(totals.bounds.max() - numbers.origin) +
                "]\n    uniform token orientation = \"rightHanded\"\n" + place + "    point3f[] points = [");
    // A line may end after a comma, but not before it.
    mPoints = TextRows(layout, totals.points, ",\n(*, *, *)", numbers);
    layout.text("]\n    int4[] tetVertexIndices = [");
    mTets = TextRows(layout, totals.tets, ",\n(#, #, #, #)", numbers);
    layout.text("]\n    int3[] surfaceFaceVertexIndices = [");
    mTriangles = TextRows(layout, totals.triangles, ",\n(#, #, #)", numbers);
    layout.text("]\n}\n");
}

} // namespace

std::unique_ptr<Format> makeUsda(const MeshTotals& totals) { return std::make_unique<Usda>(totals); }

} // namespace vdbtet
