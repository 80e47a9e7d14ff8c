/// @file Geo.cc
/// Houdini's geometry as JSON text, which Unreal's Chaos Flesh imports as well. The tets are one run of
/// primitives, with four vertices each that refer to points.
#include "io/formats/Format.h"
#include "io/formats/TextRecords.h"

namespace vdbtet {

namespace {

class Geo final : public Format {
public:
    explicit Geo(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mTets.put(files[0], chunk.firstTet, chunk.tets);
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
    }

private:
    TextRows mPoints, mTets;
};

std::string boundsOf(const MeshTotals& totals) {
    std::string list;
    for (int axis = 0; axis < 3; ++axis) {
        list += (axis == 0 ? "" : ",") + shortest(totals.bounds.min()[axis]) + "," +
                shortest(totals.bounds.max()[axis]);
    }
    return list;
}

Geo::Geo(const MeshTotals& totals) {
    const TextNumbers numbers(totals, 0);
    const std::string storage = numbers.float32 ? R"("storage","fpreal32",)" : R"("storage","fpreal64",)";
    RecordLayout& layout = mLayouts.emplace_back();
    // Unreal's parser wants each comma right behind the value before it.
    layout.text("[\n\"fileversion\",\"18.0\",\n\"hasindex\",false,\n\"pointcount\"," +
                std::to_string(totals.points) + ",\n\"vertexcount\"," + std::to_string(4 * totals.tets) +
                ",\n\"primitivecount\"," + std::to_string(totals.tets) +
                ",\n\"info\",{\"software\":\"vdbtet\",\"bounds\":[" + boundsOf(totals) +
                "]},\n\"topology\",[\"pointref\",[\"indices\",[");
    mTets = TextRows(layout, totals.tets, ",\n#,#,#,#", numbers);
    layout.text(R"(]]],
"attributes",["pointattributes",[[
["scope","public","type","numeric","name","P","options",{"type":{"type":"string","value":"point"}}],
["size",3,)" + storage +
                R"("defaults",["size",1,"storage","fpreal64","values",[0]],
"values",["size",3,)" +
                storage + R"("tuples",[)");
    mPoints = TextRows(layout, totals.points, ",\n[*,*,*]", numbers);
    layout.text(R"(]]]]]],
"primitives",[[["type","Tetrahedron_run"],["startvertex",0,"nprimitives",)" +
                std::to_string(totals.tets) + "]]]\n]\n");
}

} // namespace

std::unique_ptr<Format> makeGeo(const MeshTotals& totals) { return std::make_unique<Geo>(totals); }

} // namespace vdbtet
