/// @file CommandLine.cc
/// The options of vdb_tet, bound straight onto the library's.
#include "CommandLine.h"

#include "Console.h"
#include "Manual.h"
#include "Suggest.h"
#include "UsageError.h"
#include "report/ReportPage.h"
#include "surface/TriangleMesh.h"

#include <vdbtet/MeshFile.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace {

const std::map<std::string, vdbtet::Inside> kSides = {
    {"below", vdbtet::Inside::Below}, {"above", vdbtet::Inside::Above}, {"auto", vdbtet::Inside::Automatic}};

const std::map<std::string, vdbtet::Boundary> kBoundaries = {{"manifold", vdbtet::Boundary::Manifold},
                                                             {"fill", vdbtet::Boundary::Fill},
                                                             {"surface", vdbtet::Boundary::Fill},
                                                             {"raw", vdbtet::Boundary::Raw}};

const std::map<std::string, vdbtet::Nan> kNans = {
    {"error", vdbtet::Nan::Error}, {"inside", vdbtet::Nan::Inside}, {"outside", vdbtet::Nan::Outside}};

/// @return what is wrong with the text, or nothing
std::string isPositive(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool fine = !text.empty() && *end == '\0' && value > 0.0 && std::isfinite(value);
    return fine ? "" : text + " is not a positive number";
}

/// @brief Give --optimize its value, so that it never takes a file's name for one.
/// @return the arguments in reverse order, as CLI11 wants them
std::vector<std::string> withTargets(int argc, const char* const* argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
        if (arguments[i] != "--optimize") continue;
        const bool given = i + 1 < arguments.size() && isPositive(arguments[i + 1]).empty();
        arguments[i] += "=" + (given ? arguments[i + 1] : "30");
        if (given) arguments.erase(arguments.begin() + std::ptrdiff_t(i) + 1);
    }
    std::reverse(arguments.begin(), arguments.end());
    return arguments;
}

void check(const CommandLine& line, bool ranks) {
    if (std::count(line.inputs.begin(), line.inputs.end(), "") > 0)
        throw UsageError("IN is empty; name a file");
    if (line.out.empty() && !line.dryRun) throw UsageError("OUT is missing; --help lists the options");
    if ((!line.out.empty() || !line.format.empty()) && !(ranks && isPvtu(line))) {
        const vdbtet::MeshFormat& format =
            vdbtet::MeshFile::formatOf(line.out, line.format, line.formatOptions); // or it throws
        if (line.hasFields()) vdbtet::MeshFile::requireFields(format);
    }
    if (!line.fieldsFrom.empty() && line.sample.empty() && line.sampleCells.empty())
        throw UsageError("--fields-from is for --sample and --sample-cells, and neither is given");
    if (line.splitSurface && line.surface.empty())
        throw UsageError("--boundary surface is for what --surface writes, and that is not given");
    const bool surfaces = std::any_of(line.inputs.begin(), line.inputs.end(), isSurfaceFile);
    if (line.voxelSize && !surfaces)
        throw UsageError(
            "--voxel-size is for surfaces, .obj, .ply or .stl; the lattice of a volume is set by "
            "--voxels or --spacing");
    if (isReportPage(line.report)) requireReportPages();
    if (line.allGrids && !line.name.empty())
        throw UsageError("--all-grids takes every grid, and --name one; give only one of the two");
}

/// The last file is OUT, unless it is one more to count.
void splitFiles(CommandLine& line, std::vector<std::string> files) {
    const bool counts = line.dryRun && std::filesystem::path(files.back()).extension() == ".vdb";
    if (files.size() > 1 && !counts) {
        line.out = files.back();
        files.pop_back();
    }
    line.inputs = std::move(files);
}

/// CLI11 sees only one list of files.
struct HelpFormatter final : CLI::Formatter {
    std::string make_usage(const CLI::App*, std::string) const override {
        return "\nUsage: vdb_tet [OPTIONS] IN.vdb... [OUT]\n";
    }
};

/// What to say of arguments that CLI11 does not know.
std::string unknown(const CLI::App& app, const std::string& argument) {
    const std::string word = argument.substr(0, argument.find('='));
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
    const std::string meant = word.rfind("--", 0) == 0 ? nearestWord(word, known) : std::string();
    return meant.empty() ? fmt::format("there is no option {}; --help lists the options", word)
                         : fmt::format("there is no option {}; did you mean {}?", word, meant);
}

} // namespace

bool isPvtu(const CommandLine& line) {
    return line.format.empty() && std::filesystem::path(line.out).extension() == ".pvtu";
}

std::optional<CommandLine> parseCommandLine(int argc, const char* const* argv, bool ranks) {
    CommandLine line;
    vdbtet::Options& options = line.options;
    const CLI::Validator positive(isPositive, "");

    CLI::App app("Fill an OpenVDB volume with tetrahedra of guaranteed dihedral angles.\n", "vdb_tet");
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_version_flag("--version", "vdb_tet " VDBTET_VERSION ", OpenVDB " OPENVDB_LIBRARY_VERSION_STRING);
    std::vector<std::string> files; // with one option for OUT, too, CLI11 would give all to the first
    app.add_option(
           "IN", files,
           "IN are .vdb files that hold volumes, or .obj, .ply or .stl files of closed surfaces. OUT is "
           "the mesh to write, and may be left out with --dry-run. In OUT and the names of other files "
           "that are written {stem} stands for the input's name, {frame} for the number in it, {grid} "
           "for the grid")
        ->required()
        ->type_name("FILE");
    std::vector<std::string> formats;
    for (const vdbtet::MeshFormat& format : vdbtet::meshFormats()) formats.push_back(format.name);
    app.add_option("--format", line.format, "Format of OUT. Default: by its extension")
        ->check(CLI::IsMember(formats).description(""))
        ->type_name(fmt::format("{}", fmt::join(formats, "|")));
    app.add_flag("--compress{1}", line.formatOptions.compression,
                 "Compress OUT, a .vtu or .vtkhdf; --compress=LEVEL for 1, fast and the default, to 9, small")
        ->check(CLI::Range(1, 9).description(""));
    app.add_option("--surface", line.surface, "Write the boundary, too: .obj, .ply or .stl")
        ->type_name("FILE");
    app.add_option("-n,--name", line.name,
                   "Grid to mesh; NAME[i] for the i-th, from 0, of several grids of that name. "
                   "Default: the only scalar grid, else the only level set")
        ->type_name("NAME");
    app.add_option("--voxel-size", line.voxelSize,
                   "Of surfaces: the voxels they are turned into, in world units. Default: a 256th of the "
                   "longest side")
        ->check(positive)
        ->type_name("LENGTH");
    app.add_option("-i,--isovalue", options.isovalue,
                   "Where the surface is. Default: 0 for a level set, 0.5 for a fog volume")
        ->type_name("VALUE");
    app.add_option_function<std::string>(
           "--inside", [&options](const std::string& side) { options.inside = kSides.at(side); },
           "Mesh where values are below or above the isovalue. Default: auto, by the grid's class")
        ->check(CLI::IsMember(kSides).description(""))
        ->type_name("below|above|auto");
    app.add_option_function<std::string>(
           "--nan", [&options](const std::string& choice) { options.nan = kNans.at(choice); },
           "What NaN and infinite values are taken for; error refuses a volume that has any. Default: error")
        ->check(CLI::IsMember(kNans).description(""))
        ->type_name("error|inside|outside");
    auto* spacing =
        app.add_option("-s,--spacing", options.spacing, "Length of the lattice's long edges in world units")
            ->check(positive)
            ->type_name("LENGTH");
    app.add_option("-v,--voxels", options.voxels, "The same in voxels. Default: 1")
        ->check(positive)
        ->type_name("VOXELS")
        ->excludes(spacing);
    app.add_option_function<std::string>(
           "--boundary",
           [&line](const std::string& mode) {
               line.options.boundary = kBoundaries.at(mode);
               line.splitSurface = mode == "surface";
           },
           "Where the shape is finer than the lattice: mend the boundary until it is a manifold, only fill "
           "gaps, fill gaps and double points in what --surface writes, or leave it. Default: manifold")
        ->check(CLI::IsMember(kBoundaries).description(""))
        ->type_name("manifold|fill|surface|raw");
    auto* grade = app.add_flag("-g,--grade", options.grade,
                               "Let the tets grow towards the inside, up to 2 x a layer; the surface stays "
                               "as it is");
    app.add_option("--max-size", options.maxSize, "With --grade: the longest edge, in world units")
        ->check(positive)
        ->type_name("LENGTH")
        ->needs(grade);
    app.add_option(
           "--tiger", options.tiger,
           "Version of the method; 2 has better angles than 1, and 3 than 2 where the lattice resolves "
           "the shape. Default: 2")
        ->check(CLI::IsMember({1, 2, 3}).description(""))
        ->type_name("1|2|3");
    app.add_option("--tau", options.tau,
                   fmt::format("With --tiger 3: points inside move outwards where the surface is nearer than "
                               "this share of a short edge. Default: {}",
                               vdbtet::kDefaultTau))
        ->check(CLI::Range(0.5, 0.8).description(""))
        ->type_name("SHARE");
    auto* optimize = app.add_option("--optimize", options.optimize,
                                    "Move points until no dihedral angle is less than TARGET degrees, or no "
                                    "move helps; 30 where it is left out, at most 38. Default: do not")
                         ->type_name("[TARGET]");
    app.add_option(
           "--sweeps", options.sweeps,
           fmt::format("With --optimize: at most so many moves of a point. Default: {}", options.sweeps))
        ->check(CLI::Range(1, 1000).description(""))
        ->type_name("N")
        ->needs(optimize);
    app.add_option(
           "--max-tiles", options.maxSurfaceTiles,
           fmt::format("Refuse a surface that crosses more lattice tiles, of 8 x 8 x 8 cells, than this. "
                       "Default: {}",
                       options.maxSurfaceTiles))
        ->type_name("N");
    app.add_option("--max-tets", options.maxTets,
                   fmt::format("Refuse a mesh of more tets than this, before it is made. Default: {}",
                               options.maxTets))
        ->type_name("N");
    app.add_option("--max-memory", options.maxMemory,
                   "Refuse, before the work, what would take more memory than this by an estimate, such as "
                   "500M or 8G. Default: what is free")
        ->transform(CLI::AsSizeValue(true).description(""))
        ->type_name("SIZE");
    app.add_option("--sample", line.sample,
                   "Grids of IN whose values the points shall carry, trilinear; all for all others")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("GRID,...")
        ->group("Fields");
    app.add_option("--sample-cells", line.sampleCells,
                   "Grids whose values at their centroids the tets shall carry; all for all others")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("GRID,...")
        ->group("Fields");
    app.add_option("--fields-from", line.fieldsFrom, "The file that holds these grids. Default: IN")
        ->type_name("FILE.vdb")
        ->group("Fields");
    app.add_flag("--boundary-flag", line.boundaryFlag,
                 "Add the point field boundary: 1 on the surface, else 0")
        ->group("Fields");
    app.add_flag("--min-dihedral", line.minDihedral,
                 "Add the tet field min_dihedral: each one's smallest dihedral angle, in degrees")
        ->group("Fields");
    auto* distance = app.add_option("--distance", line.distanceWidth,
                                    "Add the point field distance: to the surface, negative inside, down to "
                                    "-WIDTH, in world units. Default: 3 voxels")
                         ->expected(0, 1)
                         ->check(positive)
                         ->type_name("[WIDTH]")
                         ->group("Fields");
    app.add_option("--scale", line.scale, "Multiply all coordinates that are written. Default: 1")
        ->check(positive)
        ->type_name("FACTOR");
    vdbtet::UsdOptions usd;
    const std::map<std::string, vdbtet::UsdOptions::Axis> axes = {{"y", vdbtet::UsdOptions::Axis::Y},
                                                                  {"z", vdbtet::UsdOptions::Axis::Z}};
    auto* upAxis = app.add_option_function<std::string>(
                          "--up-axis", [&](const std::string& axis) { usd.upAxis = axes.at(axis); },
                          "The up axis that a .usda file states; nothing is turned. Default: y")
                       ->check(CLI::IsMember(axes).description(""))
                       ->type_name("y|z")
                       ->group("OpenUSD");
    auto* metersPerUnit = app.add_option("--meters-per-unit", usd.metersPerUnit,
                                         "The unit that a .usda file states, of its coordinates. Default: 1")
                              ->check(positive)
                              ->type_name("METERS")
                              ->group("OpenUSD");
    auto* usdSurface =
        app.add_flag("--usd-surface", usd.surface, "Write the boundary into the .usda file as a Mesh, too")
            ->group("OpenUSD");
    app.add_option("-j,--threads", line.threads, "Threads to use. Default: 0, all")
        ->check(CLI::Range(0, 4096).description(""))
        ->type_name("N");
    app.add_option(
           "--report", line.report,
           "Write what was done and measured to this file: for programs, or for people, with a picture")
        ->type_name("FILE.json|FILE.html");
    app.add_flag("--dry-run", line.dryRun,
                 "Write no mesh, but count it, and say how large the file would be");
    app.add_flag("-q,--quiet", line.quiet, "Print nothing but errors");
    app.add_option("--frames", line.frames,
                   "Frames of a sequence, such as 1-240, 1-240x2 or 1,5,10-20, for inputs such as "
                   "smoke.%04d.vdb or smoke.####.vdb")
        ->type_name("LIST")
        ->group("Batches");
    app.add_flag("--all-grids", line.allGrids, "Mesh every float and double grid of the files")
        ->group("Batches");
    app.add_option("--jobs", line.jobs,
                   "Meshes to make at once, with the threads shared out. Default: 0, as many as fit into "
                   "memory")
        ->check(CLI::Range(0, 4096).description(""))
        ->type_name("N")
        ->group("Batches");
    app.add_flag("--resume", line.resume,
                 "Skip what has been written since its input was; options do not count")
        ->group("Batches");
    app.add_flag("--fail-fast", line.failFast, "Begin no other mesh after one that failed")->group("Batches");
    app.add_option("--log", line.log, "Append what happens to this file, a line of JSON an event")
        ->type_name("FILE.jsonl")
        ->group("Batches");

    app.set_help_flag("-h,--help", "Print the options used most, and examples");
    app.set_help_all_flag("--help-all", "Print all options");

    // For the build, which installs what it prints.
    if (argc == 3 && argv[1] == std::string("--generate")) {
        print(argv[2] == std::string("man") ? manPage(app) : completion(app, argv[2]));
        return std::nullopt;
    }
    try {
        app.parse(withTargets(argc, argv));
    } catch (const CLI::CallForAllHelp&) {
        print(app.help());
        return std::nullopt;
    } catch (const CLI::CallForHelp&) {
        print(helpScreen(app));
        return std::nullopt;
    } catch (const CLI::CallForVersion& version) {
        print(version.what() + std::string("\n"));
        return std::nullopt;
    } catch (const CLI::Error& error) {
        for (const std::string& argument : app.remaining()) {
            if (argument.rfind('-', 0) == 0) throw UsageError(unknown(app, argument));
        }
        throw UsageError(error.what());
    }
    splitFiles(line, std::move(files));
    line.distance = distance->count() > 0;
    if (upAxis->count() + metersPerUnit->count() + usdSurface->count() > 0) line.formatOptions.usd = usd;
    check(line, ranks);
    return line;
}
