// Values of grids at points, against the functions that the grids were filled with.
#include "support/Boundary.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Keeps the mesh and its first field.
struct FieldSink final : MeshSink {
    bool begin(const MeshTotals& announced) override {
        totals = announced;
        values.resize(std::size_t(totals.points * totals.pointFields.at(0).components));
        return mesh.begin(announced);
    }
    void chunk(const MeshChunk& chunk) override {
        const auto components = totals.pointFields[0].components;
        REQUIRE(chunk.pointFields.size() == totals.pointFields.size());
        REQUIRE(chunk.pointFields[0].size() == chunk.points.size() * std::size_t(components));
        std::copy(chunk.pointFields[0].begin(), chunk.pointFields[0].end(),
                  values.begin() + chunk.firstPoint * components);
        mesh.chunk(chunk);
    }
    void end() override { mesh.end(); }

    MeshTotals totals;
    TetMesh mesh;
    std::vector<float> values;
};

/// A ball with the values of @a grid.
FieldSink sampled(const openvdb::GridBase::ConstPtr& grid) {
    FieldSink sink;
    FieldSampler sampler(sink, {grid});
    volumeToTets(*levelSet(sphere({0.1, 0.2, 0.3}, 6)), sampler);
    return sink;
}

/// Keeps the mesh and all of its fields.
struct FieldsSink final : MeshSink {
    bool begin(const MeshTotals& announced) override {
        totals = announced;
        points.resize(totals.pointFields.size());
        cells.resize(totals.cellFields.size());
        return mesh.begin(announced);
    }
    void chunk(const MeshChunk& chunk) override {
        REQUIRE(chunk.pointFields.size() == points.size());
        REQUIRE(chunk.cellFields.size() == cells.size());
        const auto append = [](std::vector<float>& to, const ArrayView<float>& values) {
            to.insert(to.end(), values.begin(), values.end());
        };
        for (std::size_t f = 0; f < points.size(); ++f) append(points[f], chunk.pointFields[f]);
        for (std::size_t f = 0; f < cells.size(); ++f) append(cells[f], chunk.cellFields[f]);
        mesh.chunk(chunk);
    }
    void end() override { mesh.end(); }

    MeshTotals totals;
    TetMesh mesh;
    std::vector<std::vector<float>> points, cells;
};

/// Voxels of 0.5 or so, turned, around that ball.
template <typename GridT, typename ValueF>
typename GridT::Ptr filled(const ValueF& value) {
    const auto grid = GridT::create();
    grid->setName("field");
    grid->setTransform(affineTransform({0.4, 0.3, 0.0}, {-0.3, 0.4, 0.1}, {0.0, -0.1, 0.5}, {0.2, 0.1, 0.0}));
    const openvdb::CoordBBox box(openvdb::Coord(-28), openvdb::Coord(28));
    for (auto at = box.begin(); at; ++at) grid->tree().setValue(*at, value(*at));
    return grid;
}

} // namespace

TEST_CASE("a linear field comes out as it is, in world space", "[fields]") {
    const auto function = [](const Vec3d& p) { return 2.0 * p.x() - 3.0 * p.y() + 0.25 * p.z() + 1.0; };
    const auto transform =
        filled<openvdb::FloatGrid>([](const openvdb::Coord&) { return 0.0f; })->transformPtr();
    const auto grid = filled<openvdb::DoubleGrid>(
        [&](const openvdb::Coord& at) { return function(transform->indexToWorld(at)); });
    const FieldSink sink = sampled(grid);
    REQUIRE(sink.mesh.points.size() > 1000);
    double farthest = 0;
    for (std::size_t i = 0; i < sink.mesh.points.size(); ++i)
        farthest = std::max(farthest, std::abs(double(sink.values[i]) - function(sink.mesh.points[i])));
    CHECK(farthest < 3e-6); // a float's rounding, at values up to 30
}

TEST_CASE("whole numbers are interpolated, not rounded", "[fields]") {
    const auto grid =
        filled<openvdb::Int32Grid>([](const openvdb::Coord& at) { return at.x() + 2 * at.y() - 5 * at.z(); });
    const FieldSink sink = sampled(grid);
    double farthest = 0;
    for (std::size_t i = 0; i < sink.mesh.points.size(); ++i) {
        const Vec3d at = grid->transform().worldToIndex(sink.mesh.points[i]);
        const double expected = at.x() + 2 * at.y() - 5 * at.z();
        farthest = std::max(farthest, std::abs(double(sink.values[i]) - expected));
    }
    CHECK(farthest < 1e-5);
}

TEST_CASE("components of a staggered grid lie on the faces of voxels", "[fields]") {
    for (const bool staggered : {false, true}) {
        const auto grid = filled<openvdb::Vec3SGrid>([&](const openvdb::Coord& at) {
            const float shift = staggered ? 0.5f : 0.0f;
            return openvdb::Vec3f(float(at.x()) - shift, 2 * (float(at.y()) - shift),
                                  3 * (float(at.z()) - shift));
        });
        grid->setGridClass(staggered ? openvdb::GRID_STAGGERED : openvdb::GRID_UNKNOWN);
        const FieldSink sink = sampled(grid);
        REQUIRE(sink.totals.pointFields[0].components == 3);
        double farthest = 0;
        for (std::size_t i = 0; i < sink.mesh.points.size(); ++i) {
            const Vec3d at = grid->transform().worldToIndex(sink.mesh.points[i]);
            for (int c = 0; c < 3; ++c) {
                const double value = sink.values[3 * i + std::size_t(c)];
                farthest = std::max(farthest, std::abs(value - (c + 1) * at[c]));
            }
        }
        CHECK(farthest < 1e-5);
    }
}

TEST_CASE("a linear field comes out as it is at centroids, too", "[fields]") {
    const auto function = [](const Vec3d& p) { return 2.0 * p.x() - 3.0 * p.y() + 0.25 * p.z() + 1.0; };
    const auto transform =
        filled<openvdb::FloatGrid>([](const openvdb::Coord&) { return 0.0f; })->transformPtr();
    const auto grid = filled<openvdb::Vec3DGrid>([&](const openvdb::Coord& at) {
        const Vec3d p = transform->indexToWorld(at);
        return Vec3d(function(p), p.x(), p.z());
    });
    for (const bool grade : {false, true}) {
        FieldsSink sink;
        FieldOptions fields;
        fields.cellGrids = {grid};
        fields.minDihedral = true;
        FieldSampler sampler(sink, fields);
        Options options;
        options.grade = grade;
        volumeToTets(*levelSet(sphere({0.1, 0.2, 0.3}, 6)), sampler, options);
        REQUIRE(sink.totals.pointFields.empty());
        REQUIRE(sink.totals.cellFields.size() == 2);
        CHECK(sink.totals.cellFields[1].name == "min_dihedral");
        REQUIRE(sink.cells[0].size() == 3 * sink.mesh.tets.size());
        REQUIRE(sink.cells[1].size() == sink.mesh.tets.size());
        double farthest = 0, least = 180;
        for (std::size_t t = 0; t < sink.mesh.tets.size(); ++t) {
            Vec3d centroid(0.0);
            for (const std::int64_t id : sink.mesh.tets[t])
                centroid += 0.25 * sink.mesh.points[std::size_t(id)];
            const double expected[] = {function(centroid), centroid.x(), centroid.z()};
            for (std::size_t c = 0; c < 3; ++c)
                farthest = std::max(farthest, std::abs(double(sink.cells[0][3 * t + c]) - expected[c]));
            least = std::min(least, double(sink.cells[1][t]));
        }
        CHECK(farthest < 3e-6);
        CHECK(least == Approx(examine(sink.mesh).minAngle).epsilon(1e-5));
    }
}

TEST_CASE("the boundary flag is set at the corners of boundary triangles", "[fields]") {
    const auto grid = filled<openvdb::FloatGrid>([](const openvdb::Coord& at) { return float(at.x()); });
    FieldOptions fields;
    fields.pointGrids = {grid};
    fields.boundaryFlag = true;
    for (const bool grade : {false, true}) {
        for (const bool resolved : {true, false}) {
            FieldsSink sink;
            FieldSampler sampler(sink, fields);
            Options options;
            options.grade = grade;
            volumeToTets(*(resolved ? levelSet(torus({0.3, 0.2, 0.1}, 25, 12)) : randomSigns(24, 7)), sampler,
                         options);
            REQUIRE(sink.totals.pointFields.size() == 2);
            CHECK(sink.totals.pointFields[1].name == "boundary");
            std::set<std::array<double, 3>> flagged, corners;
            for (std::size_t i = 0; i < sink.mesh.points.size(); ++i) {
                const Vec3d& p = sink.mesh.points[i];
                const float flag = sink.points[1][i];
                REQUIRE((flag == 0.0f || flag == 1.0f));
                if (flag == 1.0f) flagged.insert({p.x(), p.y(), p.z()});
            }
            for (const Corners& triangle : boundaryOf(sink.mesh))
                for (const auto& corner : triangle) corners.insert(corner);
            REQUIRE_FALSE(corners.empty());
            CHECK(std::includes(flagged.begin(), flagged.end(), corners.begin(), corners.end()));
            // A single vertex outside may have become a point on the surface amidst tets.
            if (resolved) CHECK(flagged.size() == corners.size());
        }
    }
}

TEST_CASE("sampling leaves the mesh as it is", "[fields]") {
    const auto grid = filled<openvdb::FloatGrid>([](const openvdb::Coord& at) { return float(at.x()); });
    requireIdentical(sampled(grid).mesh, meshOf(*levelSet(sphere({0.1, 0.2, 0.3}, 6))).mesh);
}

TEST_CASE("fields have names of their own", "[fields]") {
    const auto grid = filled<openvdb::FloatGrid>([](const openvdb::Coord&) { return 1.0f; });
    const auto unnamed = openvdb::FloatGrid::create();
    FieldSink sink;
    FieldSampler sampler(sink, {grid, grid, unnamed});
    sampler.begin(MeshTotals());
    REQUIRE(sink.totals.pointFields.size() == 3);
    CHECK(sink.totals.pointFields[0].name == "field");
    CHECK(sink.totals.pointFields[1].name == "field_");
    CHECK(sink.totals.pointFields[2].name == "field__");

    const auto boundary = grid->deepCopy();
    boundary->setName("boundary");
    FieldsSink more;
    FieldSampler flagging(more, FieldOptions{{boundary}, {grid}, true, false});
    flagging.begin(MeshTotals());
    REQUIRE(more.totals.pointFields.size() == 2);
    CHECK(more.totals.pointFields[1].name == "boundary_");
    CHECK(more.totals.cellFields.at(0).name == "field");
}

TEST_CASE("grids that cannot be sampled are refused", "[fields]") {
    FieldSink sink;
    CHECK_THROWS_AS(FieldSampler(sink, {openvdb::MaskGrid::create()}), UnsupportedGrid);
    CHECK_FALSE(FieldSampler::canSample(*openvdb::BoolGrid::create()));
}
