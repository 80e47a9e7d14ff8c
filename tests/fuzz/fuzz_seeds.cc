/// @file fuzz_seeds.cc
/// Writes what the fuzzers begin with: FOLDER/vdb, FOLDER/mesh and FOLDER/options.
#include "support/Fixtures.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace vdbtet::test;

/// Where coordinates are positive: one branch of the tree instead of eight, for small files.
template <typename GridT = openvdb::FloatGrid>
typename GridT::Ptr ball(const std::string& name, double radius = 2.0) {
    const auto grid = std::make_shared<GridT>(*levelSet(sphere(Vec3d(radius + 2.3), radius), 0.5));
    grid->setName(name);
    return grid;
}

/// Small files of all kinds that readGrid() knows.
void writeVolumes(const fs::path& folder) {
    const auto write = [&](const std::string& name, const openvdb::GridCPtrVec& grids,
                           std::uint32_t compression) {
        openvdb::io::File file((folder / name).string());
        file.setCompression(compression);
        openvdb::MetaMap metadata;
        metadata.insertMeta("creator", openvdb::StringMetadata("fuzz_seeds"));
        file.write(grids, metadata);
    };
    using namespace openvdb::io;
    const auto half = ball("half"), twin = ball("ball");
    half->setSaveFloatAsHalf(true);
    const auto shared = openvdb::FloatGrid::create(twin->treePtr());
    shared->setName("shared");
    const auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3s(1.0f));
    vectors->setName("v");
    vectors->fill(openvdb::CoordBBox(openvdb::Coord(1), openvdb::Coord(4)), openvdb::Vec3s(2.0f));
    const auto fog = fogVolume(sphere(Vec3d(9.0), 3.0), shearedTransform(1.0));
    fog->setName("density");
    write("none.vdb", {ball("ball", 1.0)}, COMPRESS_NONE);
    write("mask.vdb", {ball("ball")}, COMPRESS_ACTIVE_MASK);
    write("zip.vdb", {ball("ball")}, COMPRESS_ZIP | COMPRESS_ACTIVE_MASK);
    write("default.vdb", {ball("ball")}, Archive::DEFAULT_COMPRESSION_FLAGS);
    write("half.vdb", {half}, COMPRESS_ACTIVE_MASK);
    write("double.vdb", {ball<openvdb::DoubleGrid>("ball", 1.0)}, COMPRESS_ACTIVE_MASK);
    write("fog.vdb", {fog, vectors}, COMPRESS_ACTIVE_MASK);
    write("shared.vdb", {twin, shared}, COMPRESS_ACTIVE_MASK);
    write("namesakes.vdb", {ball("ball", 1.0), ball("ball", 1.0), ball("", 1.0)}, COMPRESS_ACTIVE_MASK);
    write("tiles.vdb", {constantTiles(8, {openvdb::Coord(0), openvdb::Coord(8, 0, 0)}, true)},
          COMPRESS_ACTIVE_MASK);
    write("large_tile.vdb", {constantTiles(128, {openvdb::Coord(0)}, false)}, COMPRESS_ACTIVE_MASK);
    write("empty.vdb", {openvdb::FloatGrid::create(1.0f)}, COMPRESS_NONE);
    write("nothing.vdb", {}, COMPRESS_NONE);
    std::ofstream stream(folder / "stream.vdb", std::ios::binary);
    Stream(stream).write({vectors, ball("ball", 1.0)});
}

/// Random options in front of balls and tori, as fuzz_mesh reads them.
void writeMeshes(const fs::path& folder) {
    Random random(9);
    for (int i = 0; i < 60; ++i) {
        std::string bytes;
        for (int k = 0; k < 22; ++k) bytes += char(random.next());
        const Shape shape = i % 2 == 0 ? sphere(Vec3d(5.5), random.uniform(1.0, 5.0))
                                       : torus(Vec3d(5.5), 3.0, random.uniform(0.7, 2.0));
        for (int n = 0; n < 12 * 12 * 12; ++n) {
            const double value = 16.0 * shape.distance(Vec3d(n / 144, n / 12 % 12, n % 12));
            bytes += char(std::clamp(std::lround(value), -120L, 120L));
        }
        std::ofstream(folder / std::to_string(i), std::ios::binary) << bytes;
    }
}

void writeOptions(const fs::path& folder) {
    const char* const lines[] = {
        "a.vdb\no.vtu",
        "a.vdb\no.vtu\n-n\ndensity\n-i\n0.1\n--inside\nabove",
        "a.vdb\no.vtu\n--voxels\n2\n--tiger\n3\n--tau\n0.6",
        "a.vdb\no.vtu\n--spacing=0.5\n--grade\n--max-size\n2",
        "a.vdb\no.vtu\n--optimize\n35\n--sweeps\n4",
        "a.vdb\no.vtu\n--optimize",
        "a.vdb\no.vtu\n--boundary\nraw\n-gq\n-j\n4",
        "a.vdb\no.vtkhdf\n--compress",
        "a.vdb\no\n--format\nmsh22\n--surface\no.ply",
        "a.vdb\no.vtu\n--sample\nvel,t\n--sample-cells\nall\n--fields-from\nb.vdb",
        "a.vdb\no.vtu\n--distance\n2\n--boundary-flag\n--min-dihedral",
        "a.vdb\n--dry-run\n--report\no.json",
        "a.obj\no.vtu\n--voxel-size\n0.5\n--report\no.html",
        "a.vdb\no.usda\n--scale\n100\n--meters-per-unit\n0.01\n--up-axis\nz\n--usd-surface",
        "a.vdb\nb.vdb\nout/{stem}.vtu\n--jobs\n2\n--fail-fast",
        "s.%04d.vdb\nout/{frame}.vtu\n--frames\n1-24x2,30\n--resume\n--log\no.jsonl",
        "s.####.vdb\n{stem}_{grid}.ele\n--all-grids\n--frames\n-3-3",
        "a.vdb\no.vtu\n--max-tiles\n100\n--threads\n1\n--quiet",
        "--help",
        "--help-all",
        "--version",
        "--generate\nman",
        "--generate\nzsh",
        "--\n-a.vdb\n-o.vtu",
        "a.vdb\no.vtu\n--voxel\n2",
    };
    int number = 0;
    for (const char* line : lines) std::ofstream(folder / std::to_string(number++)) << line;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: fuzz_seeds FOLDER\n";
        return 2;
    }
    try {
        openvdb::initialize();
        const fs::path top = argv[1];
        for (const char* name : {"vdb", "mesh", "options"}) fs::create_directories(top / name);
        writeVolumes(top / "vdb");
        writeMeshes(top / "mesh");
        writeOptions(top / "options");
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
