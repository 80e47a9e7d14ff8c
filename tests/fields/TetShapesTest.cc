// Centroids and smallest angles that come with the tets, against those of the mesh that was written.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"

#include <tbb/global_control.h>

#include <algorithm>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Keeps the mesh and what it wants of the tets.
struct ShapeSink final : MeshSink {
    explicit ShapeSink(const MeshWants& what) : wanted(what) {}

    bool begin(const MeshTotals& totals) override { return mesh.begin(totals); }
    void chunk(const MeshChunk& chunk) override {
        REQUIRE(chunk.centroids.size() == (wanted.centroids ? chunk.tets.size() : 0));
        REQUIRE(chunk.minDihedrals.size() == (wanted.minDihedrals ? chunk.tets.size() : 0));
        REQUIRE(chunk.triangles.empty());
        centroids.insert(centroids.end(), chunk.centroids.begin(), chunk.centroids.end());
        minDihedrals.insert(minDihedrals.end(), chunk.minDihedrals.begin(), chunk.minDihedrals.end());
        mesh.chunk(chunk);
    }
    void end() override { mesh.end(); }
    MeshWants wants() const override { return wanted; }

    MeshWants wanted;
    TetMesh mesh;
    std::vector<Vec3d> centroids;
    std::vector<float> minDihedrals;
};

ShapeSink shapesOf(const openvdb::GridBase& grid, const Options& options) {
    ShapeSink sink({false, true, true});
    volumeToTets(grid, sink, options);
    return sink;
}

void requireTrue(const ShapeSink& sink, double edge) {
    double farthest = 0, worst = 0;
    for (std::size_t t = 0; t < sink.mesh.tets.size(); ++t) {
        Vec3d p[4];
        for (int i = 0; i < 4; ++i) p[i] = sink.mesh.points[std::size_t(sink.mesh.tets[t][i])];
        farthest = std::max(farthest, (sink.centroids[t] - 0.25 * (p[0] + p[1] + p[2] + p[3])).length());
        const auto angles = angleOfEdges(p[0], p[1], p[2], p[3]);
        const double least = *std::min_element(angles.begin(), angles.end());
        worst = std::max(worst, std::abs(double(sink.minDihedrals[t]) - least));
    }
    CHECK(farthest < 1e-11 * edge);
    CHECK(worst < 1e-5);
}

Options graded(double voxels, bool grade) {
    Options options = atVoxels(voxels);
    options.grade = grade;
    return options;
}

} // namespace

TEST_CASE("centroids and smallest angles are those of the tets", "[fields]") {
    for (const bool grade : {false, true}) {
        for (const double voxels : {0.7, 1.0}) {
            CAPTURE(grade, voxels);
            requireTrue(shapesOf(*levelSet(torus({0.3, 0.2, 0.1}, 25, 12)), graded(voxels, grade)), 25);
            requireTrue(shapesOf(*levelSet(noiseBall(1, {0.3, -0.2, 0.1}, 15, 4), rotatedTransform(0.9)),
                                 graded(voxels, grade)),
                        25);
            requireTrue(shapesOf(*levelSet(sphere({0.3, 0.2, 0.1}, 9), nonuniformTransform({1.0, 0.6, 1.7})),
                                 graded(voxels, grade)),
                        25);
        }
        requireTrue(shapesOf(*randomCuts(16, 5, 0.9), graded(2.0, grade)), 25);
        requireTrue(shapesOf(*randomSigns(24, 7), graded(1.0, grade)), 25);
    }
}

TEST_CASE("centroids and smallest angles of tets of many levels are theirs", "[fields]") {
    // Octants of 64 cells and more, which tiles of two tiers hold.
    const ShapeSink sink = shapesOf(*constantTiles(128, {{0, 0, 0}, {128, 0, 0}}, false), graded(1.0, true));
    REQUIRE(sink.mesh.tets.size() > 1000);
    requireTrue(sink, 256);
}

TEST_CASE("centroids and smallest angles alone are the same", "[fields]") {
    const auto grid = levelSet(torus({0.3, 0.2, 0.1}, 25, 12));
    for (const bool grade : {false, true}) {
        const ShapeSink both = shapesOf(*grid, graded(1.0, grade));
        ShapeSink centroids({false, true, false}), angles({false, false, true}), none({});
        for (ShapeSink* sink : {&centroids, &angles, &none}) volumeToTets(*grid, *sink, graded(1.0, grade));
        CHECK(centroids.centroids == both.centroids);
        CHECK(angles.minDihedrals == both.minDihedrals);
        CHECK(none.mesh.tets == both.mesh.tets);
    }
}

TEST_CASE("centroids and smallest angles do not depend on the threads", "[fields]") {
    const auto grid = levelSet(torus({0.3, 0.2, 0.1}, 25, 12));
    for (const bool grade : {false, true}) {
        const ShapeSink many = shapesOf(*grid, graded(0.5, grade));
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const ShapeSink single = shapesOf(*grid, graded(0.5, grade));
        CHECK(single.centroids == many.centroids);
        CHECK(single.minDihedrals == many.minDihedrals);
    }
}
