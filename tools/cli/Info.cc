/// @file Info.cc
/// Reads the heads of all grids, and counts the mesh of one.
#include "Info.h"

#include "Console.h"
#include "Summary.h"
#include "UsageError.h"
#include "batch/Memory.h"
#include "process/Query.h"
#include "process/ReadingLimits.h"
#include "process/Reporter.h"

#include <vdbtet/Errors.h>
#include <vdbtet/GridFile.h>
#include <vdbtet/MeshFile.h>
#include <vdbtet/VolumeToTets.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

namespace {

using json = nlohmann::ordered_json;

/// Takes the totals, and ends the run before the mesh is made.
struct Counter final : vdbtet::MeshSink, openvdb::util::NullInterrupter {
    explicit Counter(openvdb::util::NullInterrupter& host) : user(host) {}

    bool begin(const vdbtet::MeshTotals& announced) override {
        totals = announced;
        counted = true;
        return false;
    }
    void chunk(const vdbtet::MeshChunk&) override {}
    void end() override {}
    bool wasInterrupted(int percent = -1) override { return counted || user.wasInterrupted(percent); }

    openvdb::util::NullInterrupter& user;
    vdbtet::MeshTotals totals;
    bool counted = false;
};

json countMesh(const openvdb::GridBase& grid, bool graded, openvdb::util::NullInterrupter& interrupter) {
    vdbtet::Options options;
    options.grade = graded;
    options.maxTets = std::numeric_limits<std::int64_t>::max(); // none is made
    options = withMemoryLimit(options, grid);
    Counter counter(interrupter);
    const auto start = std::chrono::steady_clock::now();
    const vdbtet::Report report = vdbtet::volumeToTets(grid, counter, options, &counter);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!counter.counted) return nullptr; // interrupted
    // Measuring takes as long again as counting, and files some 0.5 s a gigabyte; see docs/benchmarks.md.
    constexpr double kSecondsPerByte = 0.5e-9, kSecondsPerCount = 1.6;
    const std::uint64_t bytes = vdbtet::MeshFile::size("mesh.vtu", counter.totals);
    return {{"rule", report.insideRule},
            {"spacing", report.spacing},
            {"points", counter.totals.points},
            {"tets", counter.totals.tets},
            {"boundaryTriangles", counter.totals.triangles},
            {"vtuBytes", bytes},
            {"memoryBytes", report.memory},
            {"seconds", kSecondsPerCount * seconds + kSecondsPerByte * double(bytes)}};
}

template <typename MetadataT>
json metadata(const openvdb::GridBase& grid, const char* name) {
    const auto found = grid.getMetadata<MetadataT>(name);
    return found ? json(found->value()) : json();
}

json describeHead(const vdbtet::GridHead& head) {
    json entry = {{"name", head.name}, {"type", head.type}};
    if (!head.grid) return entry;
    const openvdb::GridBase& grid = *head.grid;
    entry["valueType"] = grid.valueType();
    entry["class"] = openvdb::GridBase::gridClassToString(grid.getGridClass());
    const openvdb::Vec3d voxel = grid.transform().voxelSize();
    entry["voxel"] = {voxel[0], voxel[1], voxel[2]};
    entry["activeVoxels"] = metadata<openvdb::Int64Metadata>(grid, openvdb::GridBase::META_FILE_VOXEL_COUNT);
    entry["memoryBytes"] = metadata<openvdb::Int64Metadata>(grid, openvdb::GridBase::META_FILE_MEM_BYTES);
    const auto low = grid.getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
    const auto high = grid.getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
    if (low && high) {
        const openvdb::Vec3i a = low->value(), b = high->value();
        entry["box"] = {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
    }
    return entry;
}

std::string triple(const json& values, const char* separator) {
    return fmt::format("{:g}{}{:g}{}{:g}", values[0].get<double>(), separator, values[1].get<double>(),
                       separator, values[2].get<double>());
}

/// Such as 200 x 198 x 155.
std::string sizeOf(const json& box) {
    json sides;
    for (int axis = 0; axis < 3; ++axis)
        sides.push_back(box[1][axis].get<double>() - box[0][axis].get<double>() + 1.0);
    return triple(sides, " x ");
}

using Row = std::array<std::string, 7>;

Row rowOf(const json& grid) {
    constexpr std::size_t kLongest = 32;
    Row row;
    row.fill("?");
    row[0] = grid["name"];
    if (row[0].size() > kLongest) row[0] = row[0].substr(0, kLongest - 3) + "...";
    row[1] = grid["type"];
    if (!grid.contains("class")) return row;
    row[1] = grid["valueType"];
    row[2] = grid["class"];
    const json& voxel = grid["voxel"];
    const bool cube = voxel[0] == voxel[1] && voxel[1] == voxel[2];
    row[3] = cube ? fmt::format("{:g}", voxel[0].get<double>()) : triple(voxel, " x ");
    if (grid.contains("box")) row[4] = sizeOf(grid["box"]);
    if (grid["activeVoxels"].is_number()) row[5] = std::to_string(grid["activeVoxels"].get<std::int64_t>());
    if (grid["memoryBytes"].is_number()) row[6] = humanSize(grid["memoryBytes"].get<std::uint64_t>());
    return row;
}

std::string tableOf(const std::vector<Row>& rows) {
    std::array<std::size_t, 7> widths{};
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("  {:<{}}", row[i], widths[i]);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

} // namespace

json describeFile(const std::string& path, const std::string& name,
                  openvdb::util::NullInterrupter& interrupter) {
    json file = {{"file", path}, {"grids", json::array()}};
    std::optional<ReadingLimits> limits(path);
    for (const vdbtet::GridHead& head : vdbtet::readHeads(path)) file["grids"].push_back(describeHead(head));
    try {
        const auto grid = vdbtet::readGrid(path, name);
        limits.reset();
        file["meshed"] = grid->getName();
        file["uniform"] = countMesh(*grid, false, interrupter);
        file["graded"] = countMesh(*grid, true, interrupter);
    } catch (const vdbtet::Error& error) {
        file["obstacle"] = error.what();
    }
    return file;
}

std::string asText(const json& file) {
    std::string text = fmt::format("{}\n", file["file"].get<std::string>());
    std::vector<Row> rows = {{"grid", "type", "class", "voxel", "size in voxels", "active voxels", "memory"}};
    for (const json& grid : file["grids"]) rows.push_back(rowOf(grid));
    text += tableOf(rows);
    if (file.contains("obstacle"))
        return text + fmt::format("no mesh: {}\n", file["obstacle"].get<std::string>());
    for (const char* kind : {"uniform", "graded"}) {
        const json& mesh = file[kind];
        if (mesh.is_null()) continue;
        if (kind == std::string("uniform")) {
            const std::string name = file["meshed"];
            text +=
                fmt::format("meshed at the default spacing of {:g}, {}{}:\n", mesh["spacing"].get<double>(),
                            name.empty() ? "" : name + ", ", mesh["rule"].get<std::string>());
        }
        text += fmt::format(
            "  {:<8} {} tets, {} points, {} boundary triangles; as .vtu {}; about {} of memory and "
            "{:.2g} s\n",
            kind == std::string("graded") ? "--grade" : kind, mesh["tets"].get<std::int64_t>(),
            mesh["points"].get<std::int64_t>(), mesh["boundaryTriangles"].get<std::int64_t>(),
            humanSize(mesh["vtuBytes"].get<std::uint64_t>()),
            humanSize(mesh["memoryBytes"].get<std::uint64_t>()), mesh["seconds"].get<double>());
    }
    return text;
}

int info(int argc, const char* const* argv) {
    std::vector<std::string> files;
    std::string name;
    bool asJson = false;
    CLI::App app("List the grids of .vdb files, and count the meshes that vdb_tet would make.\n",
                 "vdb_tet info");
    app.add_option("IN.vdb", files, "The files")->required()->type_name("FILE");
    app.add_option("-n,--name", name, "Grid to count for. Default: the one that would be meshed")
        ->type_name("NAME");
    app.add_flag("--json", asJson, "Print a line of JSON a file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        print(app.help());
        return 0;
    } catch (const CLI::Error& error) {
        throw UsageError(error.what());
    }
    const Signals signals;
    int exitCode = 0;
    for (const std::string& path : files) {
        try {
            const json file = ask(path, signals, [&](const Channel& channel) {
                Reporter reporter(channel);
                channel.send({{"file", describeFile(path, name, reporter)}});
            })["file"];
            print(asJson ? file.dump(-1, ' ', false, json::error_handler_t::replace) + "\n" : asText(file));
        } catch (const std::runtime_error& error) {
            if (signals.first() != 0) return 128 + signals.first();
            complain(error.what());
            exitCode = 1;
        }
    }
    return exitCode;
}
