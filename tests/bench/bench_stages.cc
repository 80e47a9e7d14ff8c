/// @file bench_stages.cc
/// Times every stage of volumeToTets() and, in turns with it, what it is compared with: OpenVDB's
/// volumeToMesh() on the same grid, and copying as many bytes as the mesh has.
///
/// usage: vdbtet_bench [--benchmark_OPTION=...] GRID.vdb...
///        vdbtet_bench --write torus|box|ball N OUT.vdb   makes the fixture of resolution N
///        vdbtet_bench --floor GRID.vdb   prints the seconds of reading it and of volumeToMesh(), once
///
/// The counters of a repetition are seconds, by stage and by comparison. tests/bench/benchmark.py makes
/// tables.
#include "bench/fixtures.h"

#include <vdbtet/GridFile.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/tools/VolumeToMesh.h>

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int kThreads[] = {1, 2};

openvdb::FloatGrid::Ptr read(const std::string& path) {
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(vdbtet::readGrid(path));
    if (!grid) throw std::runtime_error(path + ": the benchmark wants a float grid");
    return grid;
}

/// Takes every chunk and keeps none, or wants none: for the stages of meshes of any size.
struct NullSink final : vdbtet::MeshSink {
    explicit NullSink(bool wantsChunks) : mWantsChunks(wantsChunks) {}
    bool begin(const vdbtet::MeshTotals&) override { return mWantsChunks; }
    void chunk(const vdbtet::MeshChunk&) override {}
    void end() override {}
    bool concurrent() const override { return true; }

private:
    bool mWantsChunks;
};

template <typename WorkF>
double secondsOn(int threads, const WorkF& work) {
    tbb::task_arena arena(threads);
    const auto start = std::chrono::steady_clock::now();
    arena.execute(work);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A grid, and memory for its mesh that is kept from round to round.
class Rounds {
public:
    explicit Rounds(const std::string& path);

    /// Everything once.
    /// @return seconds by name, and sizes
    benchmark::UserCounters run(int threads);

private:
    void copyMesh(int threads);

    openvdb::FloatGrid::Ptr mGrid;
    vdbtet::TetMesh mMesh;
    std::unique_ptr<char[]> mCopy;
};

Rounds::Rounds(const std::string& path) : mGrid(read(path)) {
    run(kThreads[std::size(kThreads) - 1]); // gets the memory and starts the threads
}

benchmark::UserCounters Rounds::run(int threads) {
    benchmark::UserCounters counters;
    NullSink dropping(true), counting(false);
    vdbtet::Report report;
    secondsOn(threads, [&] { report = vdbtet::volumeToTets(*mGrid, counting); });
    counters["measure"] = report.stages[report.stages.size() - 2].seconds; // the last is the sink's end
    counters["volumeToTets"] = secondsOn(threads, [&] { report = vdbtet::volumeToTets(*mGrid, dropping); });
    for (const auto& stage : report.stages) counters[stage.name] = stage.seconds;
    counters["worklist"] = report.worklistSeconds;
    counters["volumeToMesh"] = secondsOn(threads, [&] {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec4I> quads;
        openvdb::tools::volumeToMesh(*mGrid, points, quads, report.isovalue);
    });

    vdbtet::Options third;
    third.tiger = 3;
    secondsOn(threads, [&] { report = vdbtet::volumeToTets(*mGrid, counting, third); });
    for (const char* name : {"cuts", "layout", "labels", "destinations", "flips", "guard"}) {
        for (const auto& stage : report.stages) {
            if (stage.name == name) counters[std::string("version 3: ") + name] = stage.seconds;
        }
    }

    vdbtet::Options optimizing;
    optimizing.optimize = 30.0;
    secondsOn(threads, [&] { report = vdbtet::volumeToTets(*mGrid, counting, optimizing); });
    for (const auto& stage : report.stages) {
        if (stage.name == "optimize") counters["optimize"] = stage.seconds;
    }

    const auto bytes =
        std::size_t(report.points) * sizeof(openvdb::Vec3d) + std::size_t(report.tets) * sizeof(vdbtet::Tet);
    // The mesh and its copy must fit, and leave room.
    if (bytes < std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGESIZE)) / 3) {
        if (!mCopy) mCopy.reset(new char[bytes]);
        counters["wholeMesh"] = secondsOn(threads, [&] { vdbtet::volumeToTets(*mGrid, mMesh); });
        counters["memcpy"] = secondsOn(threads, [&] { copyMesh(threads); });
        counters["meshBytes"] = double(bytes);
    }
    counters["tets"] = double(report.tets);
    counters["gridBytes"] = double(mGrid->memUsage());
    return counters;
}

/// One piece a thread: memcpy is fastest on long ones.
void Rounds::copyMesh(int threads) {
    const auto copyPiece = [threads](char* to, const void* from, std::size_t bytes, int piece) {
        const std::size_t begin = bytes * piece / threads, end = bytes * (piece + 1) / threads;
        std::memcpy(to + begin, static_cast<const char*>(from) + begin, end - begin);
    };
    const std::size_t pointBytes = mMesh.points.size() * sizeof(openvdb::Vec3d);
    tbb::parallel_for(0, threads, [&](int piece) {
        copyPiece(mCopy.get(), mMesh.points.data(), pointBytes, piece);
        copyPiece(mCopy.get() + pointBytes, mMesh.tets.data(), mMesh.tets.size() * sizeof(vdbtet::Tet),
                  piece);
    });
    benchmark::ClobberMemory();
}

/// @return those of the grid at hand; another grid's are given up, as their memory is needed
Rounds& roundsOf(const std::string& path) {
    static std::string current;
    static std::unique_ptr<Rounds> rounds;
    if (path != current) {
        rounds.reset();
        rounds = std::make_unique<Rounds>(path);
        current = path;
    }
    return *rounds;
}

void repetition(benchmark::State& state, const std::string& path, int threads) {
    Rounds& rounds = roundsOf(path);
    while (state.KeepRunning()) {
        state.counters = rounds.run(threads);
        state.SetIterationTime(state.counters["volumeToTets"]);
    }
}

void write(const std::string& kind, int resolution, const std::string& path) {
    openvdb::FloatGrid::Ptr grid;
    if (kind == "torus") grid = vdbtet::bench::bumpyTorus(resolution);
    if (kind == "box") grid = vdbtet::bench::box(resolution);
    if (kind == "ball") grid = vdbtet::bench::ball(resolution);
    if (!grid) throw std::runtime_error("no fixture is called " + kind);
    openvdb::io::File(path).write({grid});
}

/// What a process that makes only the surface spends.
void printFloor(const std::string& path) {
    constexpr int kMost = kThreads[std::size(kThreads) - 1];
    openvdb::FloatGrid::Ptr grid;
    const double reading = secondsOn(kMost, [&] { grid = read(path); });
    const double meshing = secondsOn(kMost, [&] {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec4I> quads;
        openvdb::tools::volumeToMesh(*grid, points, quads);
    });
    std::printf("%.6f %.6f\n", reading, meshing);
}

int runBenchmarks(int argc, char** argv) {
    benchmark::Initialize(&argc, argv); // takes its own options out
    if (argc < 2) throw std::runtime_error("which grids? tools/bench.sh makes some");
    for (int i = 1; i < argc; ++i) {
        const std::string path = argv[i];
        const std::string name = std::filesystem::path(path).stem();
        for (const int threads : kThreads) {
            benchmark::RegisterBenchmark((name + "/" + std::to_string(threads)).c_str(), repetition, path,
                                         threads)
                ->Iterations(1)
                ->UseManualTime()
                ->Unit(benchmark::kSecond);
        }
    }
    return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) try {
    openvdb::initialize();
    if (argc == 5 && std::strcmp(argv[1], "--write") == 0) {
        write(argv[2], std::atoi(argv[3]), argv[4]);
        return 0;
    }
    if (argc == 3 && std::strcmp(argv[1], "--floor") == 0) {
        printFloor(argv[2]);
        return 0;
    }
    return runBenchmarks(argc, argv);
} catch (const std::exception& error) {
    std::fprintf(stderr, "vdbtet_bench: %s\n", error.what());
    return 1;
}
