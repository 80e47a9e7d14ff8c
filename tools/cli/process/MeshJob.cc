/// @file MeshJob.cc
/// The library's parts, put together as the command line says.
#include "process/MeshJob.h"

#include "Fields.h"
#include "Summary.h"
#include "batch/Memory.h"
#include "process/Query.h"
#include "process/ReadingLimits.h"
#include "process/Reporter.h"
#include "process/Signals.h"
#include "report/ReportPage.h"
#include "surface/SurfaceVolume.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>
#include <vdbtet/GridFile.h>
#include <vdbtet/MeshFile.h>
#include <vdbtet/MeshScaler.h>
#include <vdbtet/SignedDistance.h>
#include <vdbtet/SurfaceFile.h>
#include <vdbtet/VolumeToTets.h>

#include "io/OutputFile.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <memory>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Passes a mesh on to its files, or its totals to nobody in a dry run.
struct Output final : vdbtet::MeshSink {
    Output(const CommandLine& line, Reporter& host)
        : path(line.out), format(line.format), options(line.formatOptions), reporter(host) {
        if (path.empty()) path = "mesh.vtu"; // of what size would it be?
        if (line.dryRun) return;
        file = std::make_unique<vdbtet::MeshFile>(path, format, options);
        if (!line.surface.empty())
            surface = std::make_unique<vdbtet::SurfaceFile>(line.surface, line.splitSurface);
    }

    bool begin(const vdbtet::MeshTotals& totals) override {
        bytes = vdbtet::MeshFile::size(path, totals, format, options);
        if (surface) surface->begin(totals);
        return file && file->begin(totals);
    }
    void chunk(const vdbtet::MeshChunk& chunk) override {
        if (surface) surface->chunk(chunk);
        file->chunk(chunk);
        reporter.addTets(std::int64_t(chunk.tets.size()));
    }
    void end() override {
        if (surface) surface->end();
        if (!file) return;
        file->end();
        bytes = file->bytes();
    }
    bool concurrent() const override { return file && file->concurrent(); }
    vdbtet::MeshWants wants() const override {
        vdbtet::MeshWants wants = file ? file->wants() : vdbtet::MeshWants();
        wants.triangles = wants.triangles || surface;
        return wants;
    }

    std::string path, format;
    vdbtet::FormatOptions options;
    std::unique_ptr<vdbtet::MeshFile> file;
    std::unique_ptr<vdbtet::SurfaceFile> surface; ///< or null
    std::uint64_t bytes = 0;
    Reporter& reporter;
};

/// The volume, or what a surface encloses.
openvdb::GridBase::Ptr readInput(const CommandLine& line, Summary& summary, Reporter& reporter) {
    if (!isSurfaceFile(line.in)) {
        const ReadingLimits limits(line.in);
        return vdbtet::readGrid(line.in, line.name);
    }
    const TriangleMesh surface = readSurface(line.in);
    const SurfaceCheck check = checkSurface(surface);
    const std::string problems = check.problems();
    if (!problems.empty())
        summary.warnings.push_back(problems + "; what is inside may not be what was meant");
    const double voxel = line.voxelSize.value_or(defaultVoxel(surface));
    summary.surface = fmt::format("{} triangles, {}; voxels of {:g}", surface.triangles.size(),
                                  check.closed() ? "closed" : "open", voxel);
    try {
        return surfaceToVolume(surface, check, voxel, &reporter);
    } catch (vdbtet::Error& error) {
        error.prefix(line.in);
        throw;
    }
}

vdbtet::FieldOptions fieldsOf(const CommandLine& line, const openvdb::GridBase& meshed, Reporter& reporter) {
    vdbtet::FieldOptions fields;
    if (line.hasFields()) {
        const ReadingLimits limits(line.fieldsFrom.empty() ? line.in : line.fieldsFrom);
        fields = readFields(line, meshed.getName());
    }
    if (!line.distance) return fields;
    openvdb::GridBase::Ptr distance;
    if (line.dryRun) { // only its name and type count
        distance = openvdb::FloatGrid::create();
        distance->setName("distance");
    } else {
        distance = vdbtet::signedDistance(meshed, line.options, line.distanceWidth, &reporter);
    }
    fields.pointGrids.push_back(distance);
    return fields;
}

/// Do a stage that is not the mesher's.
/// @return the seconds it took
template <typename Work>
double runStage(const char* name, Reporter& reporter, const Work& work) {
    const auto start = Clock::now();
    reporter.start(name);
    work();
    reporter.end();
    return secondsSince(start);
}

void mesh(const CommandLine& line, const Channel& channel) {
    std::unique_ptr<tbb::global_control> threads;
    if (line.threads > 0) {
        threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        static_cast<std::size_t>(line.threads));
    }

    const auto start = Clock::now();
    Reporter reporter(channel);
    Summary summary;
    openvdb::GridBase::Ptr grid;
    const double readSeconds = runStage("read", reporter, [&] { grid = readInput(line, summary, reporter); });
    for (const std::string& warning : summary.warnings) channel.send({{"warning", line.in + ": " + warning}});

    // Opened before the work: what cannot be written should not be computed.
    std::unique_ptr<vdbtet::OutputFile> reportFile;
    if (!line.report.empty()) reportFile = std::make_unique<vdbtet::OutputFile>(line.report);
    Output output(line, reporter);

    vdbtet::MeshScaler scaler(output, line.scale);
    vdbtet::MeshSink& written = line.scale == 1.0 ? static_cast<vdbtet::MeshSink&>(output) : scaler;
    vdbtet::FieldOptions fields;
    const double fieldsSeconds =
        runStage("fields", reporter, [&] { fields = fieldsOf(line, *grid, reporter); });
    vdbtet::FieldSampler sampler(written, fields);

    const vdbtet::Options options = withMemoryLimit(line.options, *grid);
    summary.report = vdbtet::volumeToTets(*grid, sampler, options, &reporter);
    const vdbtet::Report& report = summary.report;
    if (report.cancelled) {
        channel.send({{"cancelled", Signals::first()}});
        return;
    }
    summary.seconds = secondsSince(start);
    auto& stages = summary.report.stages;
    if (line.hasFields()) stages.insert(stages.begin(), {"fields", fieldsSeconds});
    stages.insert(stages.begin(), {"read", readSeconds});
    summary.gridType = grid->valueType() + ", " + openvdb::GridBase::gridClassToString(grid->getGridClass());
    summary.bytes = output.bytes;
    if (output.surface) summary.surfaceSplit = output.surface->split();

    if (reportFile && isReportPage(line.report)) {
        reporter.start("report");
        if (!writeReportPage(*reportFile, line, summary, *grid, &reporter)) {
            channel.send({{"cancelled", Signals::first()}, {"written", !line.dryRun}});
            return;
        }
        reporter.end();
    } else if (reportFile) {
        const std::string json = asJson(line, summary);
        reportFile->writeAt(0, json.data(), json.size());
        reportFile->commit();
    }
    channel.send({{"done",
                   {{"text", asText(line, summary)},
                    {"grid", report.gridName},
                    {"points", report.points},
                    {"tets", report.tets},
                    {"angles", {report.angles.min, report.angles.max}},
                    {"bytes", summary.bytes},
                    {"seconds", summary.seconds}}}});
}

} // namespace

int meshJob(const CommandLine& line, const Channel& channel) {
    return tellErrors(channel, [&] { mesh(line, channel); });
}
