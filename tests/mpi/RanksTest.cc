/// Ranks make the mesh that one process makes, however the tiles are shared out.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/mpi/VolumeToTets.h>

#include <openvdb/io/File.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <string>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;

namespace {

int rankOf() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int rankCount() {
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

/// A file that rank 0 writes and all read.
class SharedGrid {
public:
    explicit SharedGrid(const openvdb::GridBase& grid) {
        char path[1024] = {};
        if (rankOf() == 0) {
            mFolder = std::make_unique<TempFolder>();
            const std::string name = mFolder->file("grid.vdb");
            openvdb::io::File(name).write(openvdb::GridCPtrVec{grid.copyGrid()});
            name.copy(path, sizeof path - 1);
        }
        MPI_Bcast(path, sizeof path, MPI_CHAR, 0, MPI_COMM_WORLD);
        mSource.path = path;
    }
    ~SharedGrid() { MPI_Barrier(MPI_COMM_WORLD); }

    const mpi::GridSource& source() const { return mSource; }

private:
    std::unique_ptr<TempFolder> mFolder;
    mpi::GridSource mSource;
};

/// Compares what a rank makes with the whole mesh.
struct Compared final : MeshSink {
    explicit Compared(const TetMesh& mesh) : whole(mesh) {}

    bool begin(const MeshTotals& totals) override {
        sameTotals = totals.points == std::int64_t(whole.points.size()) &&
                     totals.tets == std::int64_t(whole.tets.size());
        return sameTotals;
    }
    void chunk(const MeshChunk& chunk) override {
        const auto isSame = [](const auto& part, const auto& all, std::int64_t first) {
            return part.size() == 0 ||
                   std::memcmp(part.data(), all.data() + first, part.size() * sizeof(all[0])) == 0;
        };
        const bool same = isSame(chunk.points, whole.points, chunk.firstPoint) &&
                          isSame(chunk.tets, whole.tets, chunk.firstTet);
        if (!same) ++different;
        points += std::int64_t(chunk.points.size());
        tets += std::int64_t(chunk.tets.size());
    }
    void end() override { ended = true; }
    bool concurrent() const override { return true; }

    const TetMesh& whole;
    bool sameTotals = false, ended = false;
    std::atomic<std::int64_t> points{0}, tets{0}, different{0};
};

void requireSame(const openvdb::FloatGrid& grid, const Options& options, const mpi::Owner& owner,
                 Report* report = nullptr) {
    TetMesh whole;
    const Report alone = volumeToTets(grid, whole, options);
    const SharedGrid shared(grid);
    Compared sink(whole);
    const Report together = mpi::volumeToTets(shared.source(), sink, options, MPI_COMM_WORLD, owner);
    CHECK(sink.sameTotals);
    CHECK(sink.ended);
    CHECK(sink.different == 0);
    std::int64_t made[] = {sink.points, sink.tets};
    MPI_Allreduce(MPI_IN_PLACE, made, 2, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    CHECK(made[0] == alone.points);
    CHECK(made[1] == alone.tets);

    CHECK(together.boundaryTriangles == alone.boundaryTriangles);
    CHECK(together.surfaceTiles == alone.surfaceTiles);
    CHECK(together.cutEdges == alone.cutEdges);
    CHECK(together.badValues == alone.badValues);
    CHECK(together.backLabelled == alone.backLabelled);
    CHECK(together.tieBroken == alone.tieBroken);
    CHECK(together.activeFlips == alone.activeFlips);
    CHECK(together.extraFlips == alone.extraFlips);
    CHECK(together.lastResortFlips == alone.lastResortFlips);
    CHECK(together.qualityFlips == alone.qualityFlips);
    CHECK(together.flagged == alone.flagged);
    CHECK(together.guardRounds == alone.guardRounds);
    CHECK(together.angleMin == alone.angleMin);
    CHECK(together.anglesBefore.min == alone.anglesBefore.min);
    CHECK(together.anglesBefore.max == alone.anglesBefore.max);
    CHECK(together.verticesMoved == alone.verticesMoved);
    CHECK(together.sweeps == alone.sweeps);
    CHECK(together.conflicts == alone.conflicts);
    CHECK(together.ambiguous == alone.ambiguous);
    CHECK(together.tetsOfLevel == alone.tetsOfLevel);
    CHECK(together.boundary.found == alone.boundary.found);
    CHECK(together.boundary.filled == alone.boundary.filled);
    CHECK(together.boundary.peeled == alone.boundary.peeled);
    CHECK(together.boundary.split == alone.boundary.split);
    CHECK(together.boundary.left == alone.boundary.left);
    CHECK(together.angles.min == alone.angles.min);
    CHECK(together.angles.max == alone.angles.max);
    CHECK(together.angles.histogram == alone.angles.histogram);
    CHECK(together.percentiles.low == alone.percentiles.low);
    CHECK(together.bounds == alone.bounds);
    if (report) *report = together;
}

/// Any tile to any rank.
mpi::Owner atRandom(std::uint64_t seed) {
    const int ranks = rankCount();
    return [seed, ranks](const Coord& tile) {
        Random random(seed ^ (std::uint64_t(std::uint32_t(tile.x())) << 42) ^
                      (std::uint64_t(std::uint32_t(tile.y())) << 21) ^
                      std::uint64_t(std::uint32_t(tile.z())));
        random.next();
        return int(random.next() % std::uint64_t(ranks));
    };
}

/// Neighbours along any axis are different ranks'.
mpi::Owner checkered() {
    const int ranks = rankCount();
    return [ranks](const Coord& tile) {
        return int((((std::int64_t(tile.x()) + tile.y() + tile.z()) % ranks) + ranks) % ranks);
    };
}

Options raw() {
    Options options;
    options.boundary = Boundary::Raw;
    return options;
}

} // namespace

TEST_CASE("Ranks make the mesh of one process") {
    const auto grid = levelSet(gyroidBall(Vec3d(0.3, -2.1, 1.7), 24.0, 14.0, 4.0), rotatedTransform(1.0));
    for (const double voxels : {0.7, 1.0, 2.3}) {
        CAPTURE(rankOf(), voxels);
        Options options;
        options.voxels = voxels;
        requireSame(*grid, options, {});
        options.tiger = 1;
        requireSame(*grid, options, {});
    }
}

TEST_CASE("Any share-out of the tiles gives the same mesh") {
    const auto ball = levelSet(sphere(Vec3d(1.0, 2.0, 3.0), 40.0));
    const auto noise = levelSet(noiseBall(7, Vec3d(0.0), 22.0, 5.0), shearedTransform(1.0));
    for (const std::uint64_t seed : {1, 2, 3}) {
        CAPTURE(rankOf(), seed);
        requireSame(*ball, Options(), atRandom(seed));
        requireSame(*noise, Options(), atRandom(seed));
    }
    requireSame(*ball, Options(), checkered());
    requireSame(*noise, Options(), checkered());
}

TEST_CASE("One rank may do all, and another one nothing") {
    const auto ball = levelSet(sphere(Vec3d(0.0), 12.0));
    const int last = rankCount() - 1;
    requireSame(*ball, Options(), [](const Coord&) { return 0; });
    requireSame(*ball, Options(), [last](const Coord&) { return last; });
}

TEST_CASE("Labels settle across seams, cycles and ties among them") {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        CAPTURE(rankOf(), seed);
        const auto signs = randomSigns(28, seed), cuts = randomCuts(14, seed);
        Report report;
        requireSame(*signs, raw(), checkered(), &report);
        CHECK(report.backLabelled > 0);
        requireSame(*signs, raw(), atRandom(seed));
        Options wide = raw();
        wide.voxels = 2.0;
        requireSame(*cuts, wide, checkered(), &report);
        requireSame(*cuts, wide, atRandom(seed));
    }
    // Equal values on both sides of every sign change: all cut points are ties.
    const auto ties = openvdb::FloatGrid::create(1.0f);
    for (int x = 0; x < 24; ++x) {
        for (int y = 0; y < 24; ++y) {
            for (int z = 0; z < 24; ++z)
                ties->tree().setValue(Coord(x, y, z), (x / 3 + y / 3 + z / 3) % 2 == 0 ? 1.0f : -1.0f);
        }
    }
    requireSame(*ties, raw(), checkered());
    requireSame(*ties, raw(), atRandom(9));
}

TEST_CASE("What is pinched at a seam is mended as one process does") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        CAPTURE(rankOf(), seed);
        Report report;
        requireSame(*randomSigns(24, seed), Options(), checkered(), &report);
        CHECK(report.boundary.found > 0);
        requireSame(*randomSigns(24, seed), Options(), atRandom(seed));
        Options fill;
        fill.boundary = Boundary::Fill;
        requireSame(*levelSet(noiseBall(seed, Vec3d(0.0), 20.0, 3.0)), fill, atRandom(seed));
    }
}

TEST_CASE("Version 3 flags across seams what one process flags") {
    const auto gyroid = levelSet(gyroidBall(Vec3d(0.3, -2.1, 1.7), 20.0, 12.0, 3.0), rotatedTransform(1.0));
    const auto noise = levelSet(noiseBall(7, Vec3d(0.0), 16.0, 4.0), shearedTransform(1.0));
    Options third;
    third.tiger = 3;
    for (const auto& grid : {gyroid, noise}) {
        for (const bool grade : {false, true}) {
            CAPTURE(rankOf(), grade);
            third.grade = grade;
            Report report;
            requireSame(*grid, third, {}, &report);
            CHECK(report.guardRounds > 1);
            CHECK(report.qualityFlips > 0);
            requireSame(*grid, third, checkered());
            requireSame(*grid, third, atRandom(6));
        }
    }
    third.tau = 0.55;
    Report report;
    requireSame(*randomSigns(16, 1), third, checkered(), &report);
    CHECK(report.boundary.found > 0);
    CHECK(report.flagged > 0);
}

TEST_CASE("Points move across seams as in one process") {
    const auto gyroid = levelSet(gyroidBall(Vec3d(0.3, -2.1, 1.7), 18.0, 12.0, 3.0), rotatedTransform(1.0));
    const auto noise = levelSet(noiseBall(2, Vec3d(0.0), 14.0, 3.0), shearedTransform(1.0));
    Options options;
    for (const double target : {30.0, 35.0}) {
        options.optimize = target;
        CAPTURE(rankOf(), target);
        Report report;
        requireSame(*gyroid, options, checkered(), &report);
        CHECK(report.sweeps > 2);
        requireSame(*noise, options, atRandom(8));
    }
    options.grade = true;
    requireSame(*gyroid, options, atRandom(9));
    options.tiger = 3;
    requireSame(*noise, options, checkered());
}

TEST_CASE("A graded inside is that of one process") {
    const auto ball = levelSet(sphere(Vec3d(1.0, 2.0, 3.0), 50.0));
    const auto gyroid = levelSet(gyroidBall(Vec3d(0.3, -2.1, 1.7), 30.0, 40.0, 14.0), rotatedTransform(1.0));
    for (const double most : {0.0, 2.0, 8.0, 16.0}) {
        CAPTURE(rankOf(), most);
        Options options;
        options.grade = true;
        if (most > 0.0) options.maxSize = most;
        Report report;
        requireSame(*ball, options, {}, &report);
        requireSame(*ball, options, atRandom(3));
        requireSame(*gyroid, options, checkered());
        options.voxels = 0.6;
        requireSame(*gyroid, options, atRandom(4), &report);
        CHECK(report.tetsOfLevel.size() > 1);
    }
    Options pinched;
    pinched.grade = true;
    requireSame(*levelSet(noiseBall(2, Vec3d(0.0), 24.0, 3.0)), pinched, atRandom(5));
}

TEST_CASE("Constant tiles are found by the ranks that they are given to") {
    requireSame(*constantTiles(8, {Coord(0), Coord(8, 0, 0), Coord(24, 8, 0), Coord(40, 40, 40)}, true),
                Options(), {});
    requireSame(*constantTiles(128, {Coord(0), Coord(128, 128, 0)}, true), raw(), atRandom(5));
}

TEST_CASE("Values without a sign are taken for what one process takes them for") {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    const auto holes = levelSet(sphere(Vec3d(1.0, 2.0, 3.0), 30.0));
    for (int i = -30; i <= 30; i += 2) {
        holes->tree().setValue(Coord(i, 31 - std::abs(i), 4), nan);
        holes->tree().setValue(Coord(3, i, std::abs(i) - 27), infinity);
    }
    holes->tree().addTile(1, Coord(0, 0, 32), nan, true);
    Options options;
    options.nan = Nan::Inside;
    Report report;
    requireSame(*holes, options, {}, &report);
    CHECK(report.badValues == 63); // a tile among them
    options.nan = Nan::Outside;
    requireSame(*holes, options, atRandom(7));
    holes->tree().root().setBackground(nan, false);
    requireSame(*holes, options, {});
    requireSame(*holes, options, checkered());
}

TEST_CASE("A limit on memory is one of each rank") {
    const SharedGrid shared(*levelSet(sphere(Vec3d(0.0), 20.0)));
    TetMesh mesh;
    Options options;
    options.maxMemory = std::int64_t(1) << 40;
    const Report report = mpi::volumeToTets(shared.source(), mesh, options, MPI_COMM_WORLD);
    CHECK(report.memory > report.gridMemory);
    options.maxMemory = report.memory - 1;
    CHECK_THROWS_WITH(mpi::volumeToTets(shared.source(), mesh, options, MPI_COMM_WORLD),
                      Catch::Matchers::Contains("a rank's part of it"));
}

TEST_CASE("An error of one rank is that of all") {
    struct Failing final : MeshSink {
        bool begin(const MeshTotals&) override { return true; }
        void chunk(const MeshChunk&) override {
            if (rankOf() == rankCount() - 1) throw FileError("the disk is full");
        }
        void end() override { ended = true; }
        bool ended = false;
    };
    const SharedGrid shared(*levelSet(sphere(Vec3d(0.0), 20.0)));
    Failing sink;
    CHECK_THROWS_AS(mpi::volumeToTets(shared.source(), sink, Options(), MPI_COMM_WORLD), FileError);
    CHECK_FALSE(sink.ended);
    Options unknown;
    unknown.tiger = 4;
    CHECK_THROWS_AS(mpi::volumeToTets(shared.source(), sink, unknown, MPI_COMM_WORLD), BadOption);
    const auto bad = levelSet(sphere(Vec3d(0.0), 20.0));
    bad->tree().setValue(Coord(20, 0, 0), std::numeric_limits<float>::quiet_NaN());
    const SharedGrid damaged(*bad);
    CHECK_THROWS_WITH(mpi::volumeToTets(damaged.source(), sink, Options(), MPI_COMM_WORLD),
                      Catch::Matchers::Contains("1 voxels or tiles"));
}
