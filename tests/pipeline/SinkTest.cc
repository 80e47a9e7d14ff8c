// What a sink may rely on: exact totals, then chunks in order or wherever it says, and its own exceptions.
#include "support/Boundary.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MemoryLimit.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Checks the protocol as it goes.
struct StrictSink final : MeshSink {
    bool begin(const MeshTotals& announced) override {
        CHECK(begins++ == 0);
        totals = announced;
        return wantsChunks;
    }
    void chunk(const MeshChunk& chunk) override {
        CHECK(begins == 1);
        CHECK(ends == 0);
        CHECK(chunk.firstPoint == points);
        CHECK(chunk.firstTet == tets);
        points += std::int64_t(chunk.points.size());
        tets += std::int64_t(chunk.tets.size());
        for (const openvdb::Vec3d& p : chunk.points) bounds.expand(p);
        for (const Tet& tet : chunk.tets)
            for (const std::int64_t id : tet) outOfRange += id < 0 || id >= totals.points;
        largest = std::max(largest, chunk.points.size() + chunk.tets.size());
        ++chunks;
    }
    void end() override { CHECK(ends++ == 0); }

    bool wantsChunks = true;
    MeshTotals totals;
    openvdb::BBoxd bounds;
    std::int64_t points = 0, tets = 0, outOfRange = 0, chunks = 0;
    std::size_t largest = 0;
    int begins = 0, ends = 0;
};

/// Takes chunks from any thread in any order, into memory of its own that may begin anywhere.
struct ConcurrentSink final : MeshSink {
    /// @param at  offset of the tets in their memory, bytes; a multiple of 8
    explicit ConcurrentSink(std::size_t at) : offset(at) {}

    bool begin(const MeshTotals& announced) override {
        points.resize(std::size_t(announced.points));
        bytes.resize(std::size_t(announced.tets) * sizeof(Tet) + offset);
        return true;
    }
    void chunk(const MeshChunk& chunk) override {
        inPlace = inPlace && chunk.points.data() == points.data() + chunk.firstPoint &&
                  chunk.tets.data() == tets() + chunk.firstTet;
        pointsSeen += std::int64_t(chunk.points.size());
        tetsSeen += std::int64_t(chunk.tets.size());
    }
    void end() override {}
    bool concurrent() const override { return true; }
    ChunkMemory memory(std::int64_t firstPoint, std::int64_t firstTet) override {
        return {points.data() + firstPoint, tets() + firstTet};
    }
    Tet* tets() { return reinterpret_cast<Tet*>(bytes.data() + offset); }

    std::size_t offset;
    std::vector<openvdb::Vec3d> points;
    std::vector<char> bytes;
    std::atomic<bool> inPlace{true};
    std::atomic<std::int64_t> pointsSeen{0}, tetsSeen{0};
};

/// Takes chunks from any thread in any order, from memory of the mesher's.
struct CopyingSink final : MeshSink {
    bool begin(const MeshTotals& totals) override { return mesh.begin(totals); }
    void chunk(const MeshChunk& chunk) override { mesh.chunk(chunk); }
    void end() override {}
    bool concurrent() const override { return true; }

    TetMesh mesh;
};

struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws at one of its calls.
struct ThrowingSink final : MeshSink {
    enum class Where { Begin, FirstChunk, LaterChunk, End };
    explicit ThrowingSink(Where w) : where(w) {}

    bool begin(const MeshTotals&) override {
        if (where == Where::Begin) throw Refusal("no room");
        return true;
    }
    void chunk(const MeshChunk&) override {
        if (++chunks == (where == Where::FirstChunk ? 1 : where == Where::LaterChunk ? 3 : 0))
            throw Refusal("no room");
    }
    void end() override {
        ended = true;
        if (where == Where::End) throw Refusal("no room");
    }

    Where where;
    int chunks = 0;
    bool ended = false;
};

/// The most that rounding the coordinates to float32 turns any dihedral angle, degrees.
double greatestTurn(const TetMesh& mesh) {
    const auto rounded = [](const openvdb::Vec3d& p) { return openvdb::Vec3d(openvdb::Vec3f(p)); };
    double greatest = 0;
    for (const Tet& t : mesh.tets) {
        std::array<openvdb::Vec3d, 4> p, q;
        for (int i = 0; i < 4; ++i) {
            p[i] = mesh.points[std::size_t(t[i])];
            q[i] = rounded(p[i]);
        }
        const auto before = angleOfEdges(p[0], p[1], p[2], p[3]),
                   after = angleOfEdges(q[0], q[1], q[2], q[3]);
        for (int i = 0; i < 6; ++i) greatest = std::max(greatest, std::abs(after[i] - before[i]));
    }
    return greatest;
}

openvdb::FloatGrid::Ptr manyTiles() { return levelSet(sphere({0.3, -0.2, 0.1}, 41.3)); }

} // namespace

TEST_CASE("totals are exact and chunks come in order") {
    for (const double voxels : {0.8, 1.0, 3.0}) {
        StrictSink sink;
        const Report report = volumeToTets(*manyTiles(), sink, atVoxels(voxels));
        CHECK(sink.ends == 1);
        CHECK(sink.totals.points == sink.points);
        CHECK(sink.totals.tets == sink.tets);
        CHECK(sink.outOfRange == 0);
        CHECK(sink.totals.bounds == sink.bounds);
        CHECK(sink.totals.bounds == report.bounds);
        CHECK(report.points == sink.points);
        CHECK(report.tets == sink.tets);
    }
}

TEST_CASE("chunks do not grow with the mesh") {
    // A tenfold larger mesh comes in more chunks, not in larger ones.
    StrictSink small, large;
    volumeToTets(*levelSet(sphere({0.3, -0.2, 0.1}, 41.3)), small);
    volumeToTets(*levelSet(sphere({0.3, -0.2, 0.1}, 88.9)), large);
    CHECK(small.chunks > 1);
    CHECK(large.tets > 9 * small.tets);
    CHECK(large.largest < 2 * small.largest);
}

TEST_CASE("a sink that wants totals alone gets no chunks but the whole report") {
    StrictSink counting;
    counting.wantsChunks = false;
    const Report report = volumeToTets(*manyTiles(), counting);
    const Meshed whole = meshOf(*manyTiles());
    CHECK(counting.chunks == 0);
    CHECK(counting.ends == 1);
    CHECK_FALSE(report.cancelled);
    CHECK(counting.totals.tets == whole.report.tets);
    CHECK(report.points == whole.report.points);
    CHECK(report.tets == whole.report.tets);
    CHECK(report.boundaryTriangles == whole.report.boundaryTriangles);
    CHECK(report.angles.min == whole.report.angles.min);
    CHECK(report.angles.max == whole.report.angles.max);
    CHECK(report.angles.histogram == whole.report.angles.histogram);
}

TEST_CASE("a sink's exception reaches the caller") {
    using Where = ThrowingSink::Where;
    for (const Where where : {Where::Begin, Where::FirstChunk, Where::LaterChunk, Where::End}) {
        ThrowingSink sink(where);
        CAPTURE(int(where));
        CHECK_THROWS_AS(volumeToTets(*manyTiles(), sink), Refusal);
        CHECK(sink.ended == (where == Where::End));
        if (where == Where::FirstChunk) CHECK(sink.chunks == 1);
        if (where == Where::LaterChunk) CHECK(sink.chunks == 3);
    }
}

TEST_CASE("a concurrent sink gets the same mesh, made where it says") {
    const Meshed whole = meshOf(*manyTiles());
    for (const std::size_t offset : {0, 8}) {
        ConcurrentSink sink(offset);
        volumeToTets(*manyTiles(), sink);
        CHECK(sink.inPlace);
        CHECK(sink.pointsSeen == whole.report.points);
        CHECK(sink.tetsSeen == whole.report.tets);
        CHECK(sink.points == whole.mesh.points);
        CHECK(std::equal(whole.mesh.tets.begin(), whole.mesh.tets.end(), sink.tets()));
    }
    CopyingSink sink;
    volumeToTets(*manyTiles(), sink);
    requireIdentical(sink.mesh, whole.mesh);
}

TEST_CASE("a mesh in memory can be filled again") {
    TetMesh mesh;
    volumeToTets(*manyTiles(), mesh);
    volumeToTets(*levelSet(sphere({0.3, -0.2, 0.1}, 5.1)), mesh);
    requireIdentical(mesh, meshOf(*levelSet(sphere({0.3, -0.2, 0.1}, 5.1))).mesh);
}

TEST_CASE("a mesh larger than the memory streams through") {
    // 50 million tets of 32 bytes; the address space limit counts what threads reserve, too.
    const auto grid = constantTiles(128, {{0, 0, 0}, {128, 0, 0}}, false);
    const MemoryLimit limit(std::uint64_t(800) << 20);
    StrictSink sink;
    volumeToTets(*grid, sink);
    CHECK(sink.tets > 50000000);
    CHECK(sink.tets == sink.totals.tets);
    CHECK(sink.points == sink.totals.points);
    CHECK(sink.outOfRange == 0);
}

TEST_CASE(
    "where single precision is said to suffice it turns no angle by more than a hundredth of a degree") {
    bool suffices = true;
    for (const double distance : {0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e9}) {
        const auto grid = levelSet(noiseBall(1, {0.3, -0.2, 0.1}, 8.2, 3));
        grid->setTransform(uniformTransform(1.0, openvdb::Vec3d(distance)));
        StrictSink sink;
        const Meshed result = meshOf(*grid);
        volumeToTets(*grid, sink);
        CAPTURE(distance);
        if (sink.totals.float32Suffices) {
            CHECK(suffices); // farther out it never does again
            CHECK(greatestTurn(result.mesh) <= 0.01);
        } else {
            // Nor is it given up where it would do by far.
            CHECK(greatestTurn(result.mesh) > 0.0001);
        }
        suffices = sink.totals.float32Suffices;
    }
    CHECK_FALSE(suffices);
}

TEST_CASE("a sink that wants the boundary gets it with the chunks") {
    struct BoundarySink final : MeshSink {
        bool begin(const MeshTotals& announced) override {
            totals = announced;
            return mesh.begin(announced);
        }
        void chunk(const MeshChunk& chunk) override {
            CHECK(chunk.firstTriangle == std::int64_t(triangles.size()));
            triangles.insert(triangles.end(), chunk.triangles.begin(), chunk.triangles.end());
            mesh.chunk(chunk);
        }
        void end() override { mesh.end(); }
        MeshWants wants() const override { return {true, false, false}; }

        MeshTotals totals;
        TetMesh mesh;
        std::vector<Triangle> triangles;
    };
    for (const bool grade : {false, true}) {
        for (const auto& grid :
             {levelSet(torus({0.3, 0.2, 0.1}, 25, 12)), randomCuts(16, 5, 0.9), randomSigns(24, 7)}) {
            BoundarySink sink;
            Options options = atVoxels(grid->transform().voxelSize()[0]);
            options.grade = grade;
            volumeToTets(*grid, sink, options);
            REQUIRE(sink.totals.triangles == std::int64_t(sink.triangles.size()));
            REQUIRE_FALSE(sink.triangles.empty());
            REQUIRE(cornersOf(sink.mesh, sink.triangles) == boundaryOf(sink.mesh));
        }
    }
}
