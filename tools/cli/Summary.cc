/// @file Summary.cc
/// Formatting of the summary.
#include "Summary.h"

#include <openvdb/version.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace {

const char* name(vdbtet::Inside inside) { return inside == vdbtet::Inside::Below ? "below" : "above"; }

} // namespace

std::string humanSize(std::uint64_t bytes) {
    constexpr std::array units = {"bytes", "kB", "MB", "GB", "TB"};
    auto size = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; size >= 1000.0 && unit + 1 < units.size(); ++unit) size /= 1000.0;
    return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} {}", size, units[unit]);
}

std::string asText(const CommandLine& line, const Summary& summary) {
    const vdbtet::Report& r = summary.report;
    std::string text;
    const auto add = [&text](const char* key, const std::string& value) {
        text += fmt::format("{:<9} {}\n", key, value);
    };
    add("grid", fmt::format("{} ({})", r.gridName.empty() ? "unnamed" : r.gridName, summary.gridType));
    if (!summary.surface.empty()) add("surface", summary.surface);
    add("rule", r.insideRule);
    if (r.badValues > 0) {
        add("replaced", fmt::format("{} values that are NaN or infinite, taken as {}", r.badValues,
                                    line.options.nan == vdbtet::Nan::Inside ? "inside" : "outside"));
    }
    add("spacing", fmt::format("{:g}, in voxels {:g}", r.spacing, r.spacing / r.voxelSize));
    add("mesh",
        fmt::format("{} points, {} tets, {} boundary triangles", r.points, r.tets, r.boundaryTriangles));
    if (line.options.grade) {
        const std::size_t top = r.tetsOfLevel.empty() ? 0 : r.tetsOfLevel.size() - 1;
        add("graded", fmt::format("{} levels, longest edges from {:g} to {:g}", top + 1, r.spacing,
                                  std::ldexp(r.spacing, static_cast<int>(top))));
    }
    const auto bound = fmt::format("proven to lie between {:.2f} and {:.2f}", r.angleMin, r.angleMax);
    add("angles", r.tets == 0
                      ? "none"
                      : fmt::format("{:.2f} to {:.2f} degrees; {}", r.angles.min, r.angles.max, bound));
    std::string tails;
    for (std::size_t i = 0; i < r.percentiles.kPercents.size(); ++i) {
        tails += fmt::format("{}{} % below {:.2f} and above {:.2f}", i == 0 ? "" : "; ",
                             r.percentiles.kPercents[i], r.percentiles.low[i], r.percentiles.high[i]);
    }
    if (r.tets != 0) add("tails", tails);
    if (line.options.optimize) {
        add("optimized", fmt::format("from {:.2f} to {:.2f} degrees; {} points moved in {} sweeps",
                                     r.anglesBefore.min, r.anglesBefore.max, r.verticesMoved, r.sweeps));
    }
    add("dropped", fmt::format("{} ambiguous tets", r.ambiguous));
    if (r.boundary.found > 0) {
        add("boundary",
            fmt::format("not a surface at {} vertices: {} tets filled, {} taken out, {} points doubled{}",
                        r.boundary.found, r.boundary.filled, r.boundary.peeled, r.boundary.split,
                        r.boundary.left > 0 ? fmt::format("; {} left", r.boundary.left) : "") +
                (line.splitSurface && !line.dryRun
                     ? fmt::format(", {} points doubled in {}", summary.surfaceSplit, line.surface)
                     : ""));
    }
    if (r.tiger == 3) {
        add("flips", fmt::format("{} active, {} for quality", r.activeFlips, r.qualityFlips));
        add("guard", fmt::format("{} points flagged in {} rounds", r.flagged, r.guardRounds));
    } else {
        add("flips", fmt::format("{} active, {} extra, {} last resort; {} conflicts", r.activeFlips,
                                 r.extraFlips, r.lastResortFlips, r.conflicts));
    }
    std::string stages;
    for (const auto& stage : r.stages) stages += fmt::format("{} {:.3f}, ", stage.name, stage.seconds);
    add("seconds", fmt::format("{}total {:.3f}", stages, summary.seconds));
    const std::string size = fmt::format("{} ({} bytes)", humanSize(summary.bytes), summary.bytes);
    if (line.dryRun) {
        add("output", fmt::format("none, as this is a dry run; it would take {}{}",
                                  line.formatOptions.compression > 0 ? "at most " : "", size));
    } else {
        add("output", fmt::format("{}, {}", line.out, size));
    }
    return text;
}

std::string asJson(const CommandLine& line, const Summary& summary) {
    const vdbtet::Report& r = summary.report;
    nlohmann::ordered_json stages = nlohmann::ordered_json::array();
    for (const auto& stage : r.stages) stages.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
    const auto corner = [](const openvdb::Vec3d& p) { return std::array{p[0], p[1], p[2]}; };
    const nlohmann::ordered_json json = {
        {"vdbtet", VDBTET_VERSION},
        {"openvdb", OPENVDB_LIBRARY_VERSION_STRING},
        {"input", line.in},
        {"surface",
         summary.surface.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(summary.surface)},
        {"warnings", summary.warnings},
        {"output", line.dryRun ? nlohmann::ordered_json() : nlohmann::ordered_json(line.out)},
        {line.dryRun && line.formatOptions.compression > 0 ? "bytesAtMost" : "bytes", summary.bytes},
        {"scale", line.scale},
        {"gridName", r.gridName},
        {"gridType", summary.gridType},
        {"isovalue", r.isovalue},
        {"inside", name(r.inside)},
        {"insideRule", r.insideRule},
        {"spacing", r.spacing},
        {"voxelSize", r.voxelSize},
        {"tiger", r.tiger},
        {"points", r.points},
        {"tets", r.tets},
        {"tetsOfLevel", r.tetsOfLevel},
        {"boundaryTriangles", r.boundaryTriangles},
        {"boundary",
         {{"found", r.boundary.found},
          {"filled", r.boundary.filled},
          {"peeled", r.boundary.peeled},
          {"split", r.boundary.split},
          {"left", r.boundary.left},
          {"surfaceSplit", summary.surfaceSplit}}},
        {"ambiguous", r.ambiguous},
        {"conflicts", r.conflicts},
        {"activeFlips", r.activeFlips},
        {"extraFlips", r.extraFlips},
        {"lastResortFlips", r.lastResortFlips},
        {"qualityFlips", r.qualityFlips},
        {"flagged", r.flagged},
        {"guardRounds", r.guardRounds},
        {"badValues", r.badValues},
        {"surfaceTiles", r.surfaceTiles},
        {"memoryEstimate", r.memory},
        {"cutEdges", r.cutEdges},
        {"backLabelled", r.backLabelled},
        {"tieBroken", r.tieBroken},
        {"verticesMoved", r.verticesMoved},
        {"sweeps", r.sweeps},
        {"angles",
         {{"min", r.angles.min},
          {"max", r.angles.max},
          {"minBefore", r.anglesBefore.min},
          {"maxBefore", r.anglesBefore.max},
          {"provenMin", r.angleMin},
          {"provenMax", r.angleMax},
          {"percents", r.percentiles.kPercents},
          {"low", r.percentiles.low},
          {"high", r.percentiles.high},
          {"histogram", r.angles.histogram}}},
        {"bounds", {{"min", corner(r.bounds.min())}, {"max", corner(r.bounds.max())}}},
        {"stages", stages},
        {"worklistSeconds", r.worklistSeconds},
        {"seconds", summary.seconds}};
    // A file may name its grids in any encoding.
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}
