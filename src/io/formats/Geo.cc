/// @file Geo.cc
/// Houdini's geometry as JSON text, which Unreal's Chaos Flesh imports as well. The tets are one run of
/// primitives, with four vertices each that refer to points.
#include "io/formats/Format.h"
#include "io/formats/Names.h"
#include "io/formats/TextRecords.h"

namespace vdbtet {

namespace {

class Geo final : public Format {
public:
    explicit Geo(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mTets.put(files[0], chunk.firstTet, chunk.tets);
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mFields.forEach(
            chunk, [&files](const TextRows& rows, std::int64_t first, std::size_t count,
                            const ArrayView<float>& values) { rows.put(files[0], first, count, values); });
    }

private:
    TextRows mPoints, mTets;
    FieldPlaces<TextRows> mFields;
};

/// The text in front of an attribute's values.
std::string attribute(const std::string& name, const std::string& options, int size,
                      const std::string& storage) {
    const std::string shape = "[\"size\"," + std::to_string(size) + ",\"storage\",\"" + storage + "\",";
    return R"([
["scope","public","type","numeric","name",")" +
           name + R"(","options",)" + options + "],\n" + shape +
           R"("defaults",["size",1,"storage","fpreal64","values",[0]],
"values",)" +
           shape + (size == 1 ? R"("arrays",[[)" : R"("tuples",[)");
}

/// The text behind them.
const char* endOfAttribute(int size) { return size == 1 ? "]]]]]" : "]]]]"; }

/// @return the sections of fields, each an attribute behind a comma unless it is the first
std::vector<TextRows> attributes(RecordLayout& layout, const std::vector<MeshField>& fields, bool first,
                                 std::int64_t records, UniqueNames& unique, const TextNumbers& numbers) {
    std::vector<TextRows> places;
    for (const MeshField& field : fields) {
        if (!first) layout.text(",\n");
        first = false;
        layout.text(attribute(unique(identifier(field.name)), "{}", field.components, "fpreal32"));
        places.emplace_back(layout, records, field.components == 1 ? ",\n~" : ",\n[~,~,~]", numbers);
        layout.text(endOfAttribute(field.components));
    }
    return places;
}

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
    RecordLayout& layout = mLayouts.emplace_back();
    // Unreal's parser wants each comma right behind the value before it.
    layout.text("[\n\"fileversion\",\"18.0\",\n\"hasindex\",false,\n\"pointcount\"," +
                std::to_string(totals.points) + ",\n\"vertexcount\"," + std::to_string(4 * totals.tets) +
                ",\n\"primitivecount\"," + std::to_string(totals.tets) +
                ",\n\"info\",{\"software\":\"vdbtet\",\"bounds\":[" + boundsOf(totals) +
                "]},\n\"topology\",[\"pointref\",[\"indices\",[");
    mTets = TextRows(layout, totals.tets, ",\n#,#,#,#", numbers);
    layout.text("]]],\n\"attributes\",[\"pointattributes\",[" +
                attribute("P", R"({"type":{"type":"string","value":"point"}})", 3,
                          numbers.float32 ? "fpreal32" : "fpreal64"));
    mPoints = TextRows(layout, totals.points, ",\n[*,*,*]", numbers);
    layout.text(endOfAttribute(3));
    UniqueNames ofPoints, ofTets;
    ofPoints("P");
    mFields.points = attributes(layout, totals.pointFields, false, totals.points, ofPoints, numbers);
    if (!totals.cellFields.empty()) layout.text("],\n\"primitiveattributes\",[");
    mFields.cells = attributes(layout, totals.cellFields, true, totals.tets, ofTets, numbers);
    layout.text(R"(]],
"primitives",[[["type","Tetrahedron_run"],["startvertex",0,"nprimitives",)" +
                std::to_string(totals.tets) + "]]]\n]\n");
}

} // namespace

std::unique_ptr<Format> makeGeo(const MeshTotals& totals) { return std::make_unique<Geo>(totals); }

} // namespace vdbtet
