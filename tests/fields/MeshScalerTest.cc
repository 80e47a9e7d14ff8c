// Coordinates times a factor, and all else as it was.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>
#include <vdbtet/MeshScaler.h>

#include <algorithm>
#include <limits>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Keeps the mesh, its totals and its centroids.
struct CentroidSink final : MeshSink {
    bool begin(const MeshTotals& announced) override {
        totals = announced;
        return mesh.begin(announced);
    }
    void chunk(const MeshChunk& chunk) override {
        centroids.insert(centroids.end(), chunk.centroids.begin(), chunk.centroids.end());
        mesh.chunk(chunk);
    }
    void end() override { mesh.end(); }
    MeshWants wants() const override { return {false, true, false}; }

    MeshTotals totals;
    TetMesh mesh;
    std::vector<Vec3d> centroids;
};

} // namespace

TEST_CASE("all positions are scaled, and no ids", "[fields]") {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 12.0));
    CentroidSink plain, scaled;
    volumeToTets(*grid, plain);
    MeshScaler scaler(scaled, 2.5);
    volumeToTets(*grid, scaler);
    const auto times = [](std::vector<Vec3d> positions) {
        for (Vec3d& p : positions) p *= 2.5;
        return positions;
    };
    CHECK(scaled.mesh.points == times(plain.mesh.points));
    CHECK(scaled.centroids == times(plain.centroids));
    CHECK(scaled.mesh.tets == plain.mesh.tets);
    CHECK(scaled.totals.bounds.min() == 2.5 * plain.totals.bounds.min());
    CHECK(scaled.totals.bounds.max() == 2.5 * plain.totals.bounds.max());
    CHECK(scaled.totals.float32Suffices);
}

TEST_CASE("single precision does not suffice beyond its range", "[fields]") {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 12.0));
    for (const double factor : {1e-35, 1e38}) {
        CentroidSink sink;
        MeshScaler scaler(sink, factor);
        volumeToTets(*grid, scaler);
        CHECK_FALSE(sink.totals.float32Suffices);
    }
}

TEST_CASE("factors that cannot be are refused", "[fields]") {
    CentroidSink sink;
    for (const double factor :
         {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        CHECK_THROWS_AS(MeshScaler(sink, factor), BadOption);
    }
    MeshScaler scaler(sink, 1e308);
    CHECK_THROWS_AS(volumeToTets(*levelSet(sphere({0.3, -0.2, 0.1}, 12.0)), scaler), TooLarge);
}
