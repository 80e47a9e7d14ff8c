/// @file bench_volume_to_tets.cc
/// Times the stages of volumeToTets() on 1 and 2 threads, next to OpenVDB's volumeToMesh() on the same grid.
///
/// usage: vdbtet_bench [GRID.vdb [RUNS]]   prints a Markdown table of medians. Without a file: a sphere 256
/// wide.
#include <vdbtet/GridFile.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

namespace {

/// Takes every chunk and keeps none.
struct NullSink final : vdbtet::MeshSink {
    bool begin(const vdbtet::MeshTotals&) override { return true; }
    void chunk(const vdbtet::MeshChunk&) override {}
    void end() override {}
};

struct Timings {
    std::vector<std::string> stages; // in the order of work
    std::map<std::string, std::vector<double>> seconds;
    double tets = 0;

    void add(const std::string& stage, double value) {
        if (seconds[stage].empty()) stages.push_back(stage);
        seconds[stage].push_back(value);
    }
    double median(const std::string& stage) const {
        std::vector<double> values = seconds.at(stage);
        std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
        return values[values.size() / 2];
    }
};

template <typename WorkF>
double time(const WorkF& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The two alternate, so that whatever else the machine does meets both.
Timings measure(const openvdb::FloatGrid& grid, int threads, int runs) {
    tbb::task_arena arena(threads);
    Timings timings;
    for (int run = -1; run < runs; ++run) { // the first only warms up
        vdbtet::Report report;
        NullSink sink;
        const double ours = time([&] { arena.execute([&] { report = vdbtet::volumeToTets(grid, sink); }); });
        const double theirs = time([&] {
            std::vector<openvdb::Vec3s> points;
            std::vector<openvdb::Vec4I> quads;
            arena.execute([&] { openvdb::tools::volumeToMesh(grid, points, quads, report.isovalue); });
        });
        if (run < 0) continue;
        for (const auto& stage : report.stages) timings.add(stage.name, stage.seconds);
        timings.add("volumeToTets", ours);
        timings.add("volumeToMesh", theirs);
        timings.tets = double(report.tets);
    }
    return timings;
}

} // namespace

int main(int argc, char** argv) try {
    openvdb::initialize();
    const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
    const auto grid =
        argc > 1 ? openvdb::gridPtrCast<openvdb::FloatGrid>(vdbtet::readGrid(argv[1]))
                 : openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(125.0f, openvdb::Vec3f(0), 1.0f);
    if (!grid) throw std::runtime_error("the benchmark wants a float grid");

    const Timings one = measure(*grid, 1, runs), two = measure(*grid, 2, runs);
    const auto row = [](const std::string& name, const char* format, double a, double b) {
        std::printf("| %s | ", name.c_str());
        std::printf(format, a);
        std::printf(" | ");
        std::printf(format, b);
        std::printf(" |\n");
    };
    std::printf("%s, %.0f tets, median of %d runs, OpenVDB %s\n\n", argc > 1 ? argv[1] : "sphere", one.tets,
                runs, OPENVDB_LIBRARY_VERSION_STRING);
    std::printf("| seconds | 1 thread | 2 threads |\n|---|---|---|\n");
    for (const std::string& stage : one.stages) row(stage, "%.4f", one.median(stage), two.median(stage));
    row("million tets/s", "%.1f", one.tets / one.median("volumeToTets") / 1e6,
        two.tets / two.median("volumeToTets") / 1e6);
    row("volumeToTets / volumeToMesh", "%.1f", one.median("volumeToTets") / one.median("volumeToMesh"),
        two.median("volumeToTets") / two.median("volumeToMesh"));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "vdbtet_bench: %s\n", error.what());
    return 1;
}
