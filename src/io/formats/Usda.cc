/// @file Usda.cc
/// OpenUSD as text: a prim of the schema TetMesh (USD 24.03).
#include "io/formats/Format.h"
#include "io/formats/Names.h"
#include "io/formats/TextRecords.h"

#include <limits>

namespace vdbtet {

namespace {

class Usda final : public Format {
public:
    Usda(const MeshTotals& totals, const UsdOptions& options);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override {
        mPoints.put(files[0], chunk.firstPoint, chunk.points);
        mTets.put(files[0], chunk.firstTet, chunk.tets);
        mTriangles.put(files[0], chunk.firstTriangle, chunk.triangles);
        if (mHasSurface) {
            mCounts.put(files[0], chunk.firstTriangle, chunk.triangles);
            mCorners.put(files[0], chunk.firstTriangle, chunk.triangles);
        }
        mFields.forEach(
            chunk, [&files](const TextRows& rows, std::int64_t first, std::size_t count,
                            const ArrayView<float>& values) { rows.put(files[0], first, count, values); });
    }

private:
    /// @return the names in the file
    std::vector<std::string> layOutFields(const std::vector<MeshField>& fields, std::int64_t records,
                                          const char* interpolation, const TextNumbers& numbers,
                                          std::vector<TextRows>& places);
    void layOutSurface(const MeshTotals& totals, const std::vector<std::string>& cellFields,
                       const TextNumbers& numbers);

    bool mHasSurface;
    TextRows mPoints, mTets, mTriangles, mCounts, mCorners;
    FieldPlaces<TextRows> mFields;
    UniqueNames mUnique;
};

const char* typeOf(const MeshField& field) { return field.components == 1 ? "float[]" : "float3[]"; }

template <typename Real>
std::string tuple(const openvdb::Vec3d& p) {
    return "(" + shortest(Real(p.x())) + ", " + shortest(Real(p.y())) + ", " + shortest(Real(p.z())) + ")";
}

Usda::Usda(const MeshTotals& totals, const UsdOptions& options) : mHasSurface(options.surface) {
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
    layout.text(
        "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    metersPerUnit = " + shortest(options.metersPerUnit) +
        "\n    upAxis = \"" + (options.upAxis == UsdOptions::Axis::Y ? "Y" : "Z") + "\"\n)\n\n");
    layout.text(mHasSurface ? "def Xform \"mesh\"\n{\ndef TetMesh \"tets\"\n{\n"
                            : "def TetMesh \"mesh\"\n{\n");
    layout.text("    float3[] extent = [" + tuple<float>(totals.bounds.min() - numbers.origin) + ", " +
                tuple<float>(totals.bounds.max() - numbers.origin) +
                "]\n    uniform token orientation = \"rightHanded\"\n" + place + "    point3f[] points = [");
    // A line may end after a comma, but not before it.
    mPoints = TextRows(layout, totals.points, ",\n(*, *, *)", numbers);
    layout.text("]\n    int4[] tetVertexIndices = [");
    mTets = TextRows(layout, totals.tets, ",\n(#, #, #, #)", numbers);
    layout.text("]\n    int3[] surfaceFaceVertexIndices = [");
    mTriangles = TextRows(layout, totals.triangles, ",\n(#, #, #)", numbers);
    layout.text("]\n");
    layOutFields(totals.pointFields, totals.points, "vertex", numbers, mFields.points);
    const auto cellFields = layOutFields(totals.cellFields, totals.tets, "uniform", numbers, mFields.cells);
    layout.text("}\n");
    if (mHasSurface) layOutSurface(totals, cellFields, numbers);
}

/// Primvars: of points "vertex", of tets "uniform", as of any other gprim.
std::vector<std::string> Usda::layOutFields(const std::vector<MeshField>& fields, std::int64_t records,
                                            const char* interpolation, const TextNumbers& numbers,
                                            std::vector<TextRows>& places) {
    RecordLayout& layout = mLayouts[0];
    std::vector<std::string> names;
    for (const MeshField& field : fields) {
        names.push_back(mUnique(identifier(field.name)));
        layout.text(std::string("    ") + typeOf(field) + " primvars:" + names.back() + " = [");
        places.emplace_back(layout, records, field.components == 1 ? ",\n~" : ",\n(~, ~, ~)", numbers);
        layout.text(std::string("] (\n        interpolation = \"") + interpolation + "\"\n    )\n");
    }
    return names;
}

/// A Mesh that takes all it can from the TetMesh by reference. Fields in tets do not fit its faces.
void Usda::layOutSurface(const MeshTotals& totals, const std::vector<std::string>& cellFields,
                         const TextNumbers& numbers) {
    RecordLayout& layout = mLayouts[0];
    layout.text("def Mesh \"surface\" (\n    references = </mesh/tets>\n)\n{\n"
                "    uniform token subdivisionScheme = \"none\"\n");
    for (std::size_t f = 0; f < cellFields.size(); ++f) {
        layout.text(std::string("    ") + typeOf(totals.cellFields[f]) + " primvars:" + cellFields[f] +
                    " = None\n");
    }
    layout.text("    int[] faceVertexCounts = [");
    mCounts = TextRows(layout, totals.triangles, ",\n3", numbers);
    layout.text("]\n    int[] faceVertexIndices = [");
    mCorners = TextRows(layout, totals.triangles, ",\n#, #, #", numbers);
    layout.text("]\n}\n}\n");
}

} // namespace

std::unique_ptr<Format> makeUsda(const MeshTotals& totals, const UsdOptions& options) {
    return std::make_unique<Usda>(totals, options);
}

} // namespace vdbtet
