/// @file vdb_tet.cc
/// The command-line tool: parse, read, mesh into a sink, tell.
#include "CommandLine.h"
#include "SignalInterrupter.h"
#include "Summary.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>
#include <vdbtet/GridFile.h>
#include <vdbtet/MeshFile.h>
#include <vdbtet/MeshScaler.h>
#include <vdbtet/SignedDistance.h>
#include <vdbtet/SurfaceFile.h>
#include <vdbtet/VolumeToTets.h>

#include "io/OutputFile.h"

#include <fmt/core.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <new>

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Passes a mesh on to its files, or its totals to nobody in a dry run.
struct Output final : vdbtet::MeshSink {
    explicit Output(const CommandLine& line)
        : path(line.out), format(line.format), options(line.formatOptions) {
        if (path.empty()) path = "mesh.vtu"; // of what size would it be?
        if (line.dryRun) return;
        file = std::make_unique<vdbtet::MeshFile>(path, format, options);
        if (!line.surface.empty()) surface = std::make_unique<vdbtet::SurfaceFile>(line.surface);
    }

    bool begin(const vdbtet::MeshTotals& totals) override {
        bytes = vdbtet::MeshFile::size(path, totals, format, options);
        if (surface) surface->begin(totals);
        return file && file->begin(totals);
    }
    void chunk(const vdbtet::MeshChunk& chunk) override {
        if (surface) surface->chunk(chunk);
        file->chunk(chunk);
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
};

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw vdbtet::FileError("cannot write to standard output");
    }
}

/// The grids of a list of names.
std::vector<openvdb::GridBase::ConstPtr> gridsOf(const std::vector<std::string>& names,
                                                 const CommandLine& line, const openvdb::GridBase& meshed) {
    if (names.empty()) return {};
    const bool elsewhere = !line.fieldsFrom.empty();
    const bool all = names.size() == 1 && names[0] == "all";
    return vdbtet::readFields(elsewhere ? line.fieldsFrom : line.in, all ? std::vector<std::string>() : names,
                              elsewhere ? std::string() : meshed.getName());
}

vdbtet::FieldOptions fieldsOf(const CommandLine& line, const openvdb::GridBase& meshed,
                              SignalInterrupter& interrupter) {
    vdbtet::FieldOptions fields;
    fields.pointGrids = gridsOf(line.sample, line, meshed);
    fields.cellGrids =
        line.sampleCells == line.sample ? fields.pointGrids : gridsOf(line.sampleCells, line, meshed);
    fields.boundaryFlag = line.boundaryFlag;
    fields.minDihedral = line.minDihedral;
    if (!line.distance) return fields;
    openvdb::GridBase::Ptr distance;
    if (line.dryRun) { // only its name and type count
        distance = openvdb::FloatGrid::create();
        distance->setName("distance");
    } else {
        distance = vdbtet::signedDistance(meshed, line.options, line.distanceWidth, &interrupter);
    }
    fields.pointGrids.push_back(distance);
    return fields;
}

int run(const CommandLine& line) {
    SignalInterrupter interrupter;
    std::unique_ptr<tbb::global_control> threads;
    if (line.threads > 0) {
        threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        static_cast<std::size_t>(line.threads));
    }

    const auto start = Clock::now();
    const auto grid = vdbtet::readGrid(line.in, line.name);
    const double readSeconds = secondsSince(start);

    // Opened before the work: what cannot be written should not be computed.
    std::unique_ptr<vdbtet::OutputFile> reportFile;
    if (!line.report.empty()) reportFile = std::make_unique<vdbtet::OutputFile>(line.report);
    Output output(line);

    vdbtet::MeshScaler scaler(output, line.scale);
    vdbtet::MeshSink& written = line.scale == 1.0 ? static_cast<vdbtet::MeshSink&>(output) : scaler;
    const auto fieldsStart = Clock::now();
    vdbtet::FieldSampler sampler(written, fieldsOf(line, *grid, interrupter));
    const double fieldsSeconds = secondsSince(fieldsStart);

    Summary summary;
    summary.report = vdbtet::volumeToTets(*grid, sampler, line.options, &interrupter);
    if (summary.report.cancelled) {
        fmt::print(stderr, "vdb_tet: interrupted; nothing was written\n");
        return 128 + interrupter.signal();
    }
    summary.seconds = secondsSince(start);
    auto& stages = summary.report.stages;
    if (line.hasFields()) stages.insert(stages.begin(), {"fields", fieldsSeconds});
    stages.insert(stages.begin(), {"read", readSeconds});
    summary.gridType = grid->valueType() + ", " + openvdb::GridBase::gridClassToString(grid->getGridClass());
    summary.bytes = output.bytes;

    if (reportFile) {
        const std::string json = asJson(line, summary);
        reportFile->writeAt(0, json.data(), json.size());
        reportFile->commit();
    }
    if (!line.quiet) print(asText(line, summary));
    return 0;
}

int fail(std::string message, int exitCode) {
    // Names of files and grids may hold anything; an error is one line all the same.
    for (char& c : message) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    }
    fmt::print(stderr, "vdb_tet: {}\n", message);
    return exitCode;
}

} // namespace

int main(int argc, char** argv) {
    // OpenVDB logs through cerr; errors reach the user as exceptions, and go to stderr as one line.
    std::cerr.rdbuf(nullptr);
    try {
        const auto line = parseCommandLine(argc, argv);
        return line ? run(*line) : 0;
    } catch (const UsageError& error) {
        return fail(error.what(), 2);
    } catch (const vdbtet::BadOption& error) {
        return fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return fail("out of memory", 1);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}
