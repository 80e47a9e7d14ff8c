/// @file PageData.cc
/// The report, the options, the grid's metadata, places and the worst tets.
#include "report/PageData.h"

#include <vdbtet/Errors.h>
#include <vdbtet/GridFile.h>
#include <vdbtet/Quality.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::array<std::string, 2>>;

std::string text(const openvdb::Vec3d& v) { return fmt::format("{:g}, {:g}, {:g}", v[0], v[1], v[2]); }

Json place(const openvdb::Vec3d& p, double scale) { return {scale * p[0], scale * p[1], scale * p[2]}; }

Rows optionRows(const CommandLine& line, const vdbtet::Report& report) {
    const vdbtet::Options& options = line.options;
    Rows rows = {
        {"spacing", fmt::format("{:g}, in voxels {:g}", report.spacing, report.spacing / report.voxelSize)},
        {"rule", report.insideRule},
        {"TIGER", fmt::format("version {}", report.tiger)}};
    const std::array<const char*, 3> boundaries = {"manifold", "fill", "raw"};
    rows.push_back({"boundary", line.splitSurface
                                    ? "surface"
                                    : boundaries.at(static_cast<std::size_t>(options.boundary))});
    rows.push_back({"graded inside", options.grade ? "yes" : "no"});
    if (options.maxSize) rows.push_back({"longest edge", fmt::format("{:g}", *options.maxSize)});
    rows.push_back({"optimised", options.optimize ? fmt::format("to {:g}°, in at most {} sweeps",
                                                                *options.optimize, options.sweeps)
                                                  : "no"});
    if (line.scale != 1.0) rows.push_back({"coordinates times", fmt::format("{:g}", line.scale)});
    if (!line.format.empty()) rows.push_back({"format", line.format});
    if (line.formatOptions.compression > 0)
        rows.push_back({"compressed", fmt::format("level {}", line.formatOptions.compression)});
    if (!line.surface.empty()) rows.push_back({"boundary written to", line.surface});
    if (!line.sample.empty())
        rows.push_back({"sampled at points", fmt::format("{}", fmt::join(line.sample, ", "))});
    if (!line.sampleCells.empty())
        rows.push_back({"sampled in tets", fmt::format("{}", fmt::join(line.sampleCells, ", "))});
    if (line.threads > 0) rows.push_back({"threads", std::to_string(line.threads)});
    return rows;
}

void addMetadata(Rows& rows, const char* of, const openvdb::MetaMap& metadata) {
    constexpr std::size_t kLongest = 1000, kMost = 200; // a file may hold anything
    std::size_t count = 0;
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
        if (++count > kMost) continue;
        std::string value = entry->second->str();
        if (value.size() > kLongest) value = value.substr(0, kLongest) + "…";
        rows.push_back({fmt::format("{}: {}", of, entry->first.substr(0, kLongest)), value});
    }
    if (count > kMost) rows.push_back({fmt::format("{}: others", of), std::to_string(count - kMost)});
}

Rows inputRows(const CommandLine& line, const openvdb::GridBase& grid) {
    const openvdb::math::Transform& transform = grid.transform();
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0.0));
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    Rows rows = {{"file", line.in},
                 {"grid", grid.getName()},
                 {"class", openvdb::GridBase::gridClassToString(grid.getGridClass())},
                 {"type", grid.type()},
                 {"creator", grid.getCreator()},
                 {"voxel size", text(transform.voxelSize())},
                 {"transform", transform.mapType()},
                 {"voxel 0, 0, 0 at", text(origin)}};
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d step(0.0);
        step[axis] = 1.0;
        rows.push_back(
            {fmt::format("a step along {}", "ijk"[axis]), text(transform.indexToWorld(step) - origin)});
    }
    rows.push_back({"active voxels", std::to_string(grid.activeVoxelCount())});
    if (!box.empty()) {
        rows.push_back({"from voxel", text(box.min().asVec3d())});
        rows.push_back({"to voxel", text(box.max().asVec3d())});
    }
    addMetadata(rows, "grid's", grid);
    try {
        addMetadata(rows, "file's", vdbtet::readFileMetadata(line.in));
    } catch (const vdbtet::FileError&) {
        // The grid has been read, so this is no .vdb file, or no longer the same: the page does without.
    }
    return rows;
}

const char* name(Picture::Kind kind) {
    switch (kind) {
    case Picture::Kind::Whole:
        return "whole";
    case Picture::Kind::SameSurface:
        return "same surface";
    case Picture::Kind::Coarser:
        return "coarser";
    default:
        return "none";
    }
}

/// The tets with the smallest angles, and those with the largest.
Json worstTets(const std::vector<vdbtet::AngleRange>& angles) {
    constexpr std::size_t kSome = 5;
    std::vector<std::uint32_t> order(angles.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto first = [&](const auto& badness) {
        const auto end = order.begin() + std::ptrdiff_t(std::min(kSome, order.size()));
        std::partial_sort(order.begin(), end, order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::make_pair(badness(angles[a]), a) < std::make_pair(badness(angles[b]), b);
        });
        Json tets = Json::array();
        for (auto tet = order.begin(); tet != end; ++tet)
            tets.push_back({{"tet", *tet}, {"min", angles[*tet].min}, {"max", angles[*tet].max}});
        return tets;
    };
    return {{"small", first([](const vdbtet::AngleRange& range) { return range.min; })},
            {"large", first([](const vdbtet::AngleRange& range) { return -range.max; })}};
}

} // namespace

std::vector<vdbtet::AngleRange> anglesOf(const vdbtet::TetMesh& mesh) {
    std::vector<vdbtet::AngleRange> ranges(mesh.tets.size());
    tbb::parallel_for(std::size_t(0), ranges.size(), [&](std::size_t i) {
        const auto at = [&](int corner) {
            return mesh.points[static_cast<std::size_t>(mesh.tets[i][corner])];
        };
        const auto angles = vdbtet::dihedralAngles(at(0), at(1), at(2), at(3));
        const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
        ranges[i] = {*least, *most};
    });
    return ranges;
}

std::string pageData(const CommandLine& line, const Summary& summary, const openvdb::GridBase& grid,
                     const Picture& picture, const std::vector<vdbtet::AngleRange>& angles) {
    const vdbtet::Report& report = summary.report;
    const auto places = [&](const std::vector<openvdb::Vec3d>& of) {
        Json all = Json::array();
        for (const openvdb::Vec3d& one : of) all.push_back(place(one, line.scale));
        return all;
    };
    Json bins = Json::array();
    for (const vdbtet::AngleBin& bin : report.angleBins) bins.push_back({bin.low, bin.high, bin.count});
    const auto& usd = line.formatOptions.usd;
    const bool zUp = usd && usd->upAxis == vdbtet::UsdOptions::Axis::Z;
    const bool shown = picture.kind != Picture::Kind::None;
    const Json json = {
        {"run", Json::parse(asJson(line, summary))},
        {"options", optionRows(line, report)},
        {"input", inputRows(line, grid)},
        {"angleBins", bins},
        {"places",
         {{"ambiguous", places(report.places.ambiguous)},
          {"conflicts", places(report.places.conflicts)},
          {"pinched", places(report.places.pinched)}}},
        {"picture",
         {{"kind", name(picture.kind)},
          {"why", picture.why},
          {"tets", shown ? picture.report.tets : 0},
          {"points", shown ? picture.report.points : 0},
          {"triangles", shown ? picture.report.boundaryTriangles : 0},
          {"center", place(shown ? picture.report.bounds.getCenter() : openvdb::Vec3d(0.0), line.scale)},
          {"spacing", line.scale * picture.report.spacing},
          {"up", zUp ? 2 : 1}}},
        {"worst", worstTets(angles)}};
    // Names may be in any encoding, and hold tags; a "<" within JSON is within a string.
    std::string data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = data.find('<'); at != std::string::npos; at = data.find('<', at))
        data.replace(at, 1, "\\u003c");
    return data;
}
