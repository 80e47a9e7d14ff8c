/// @file GridFileTest.cc
/// Files that openvdb::io::File reads wrongly or not at all. The choice among grids is tested in tests/cli.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/GridFile.h>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <fstream>
#include <iterator>

namespace {

using namespace vdbtet;
using test::TempFolder;

openvdb::FloatGrid::Ptr ball() {
    const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0), 0.1f);
    grid->setName("ball");
    return grid;
}

bool isBall(const openvdb::GridBase::Ptr& grid) {
    const auto expected = ball();
    const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    if (!floats || !floats->tree().hasSameTopology(expected->tree())) return false;
    if (floats->transform() != expected->transform() || floats->getName() != "ball") return false;
    for (auto a = floats->cbeginValueAll(), b = expected->cbeginValueAll(); a; ++a, ++b) {
        if (*a != *b) return false;
    }
    return true;
}

void write(const std::string& path, const openvdb::GridCPtrVec& grids,
           std::uint32_t compression = openvdb::io::COMPRESS_NONE) {
    openvdb::io::File file(path);
    file.setCompression(compression);
    file.write(grids);
}

} // namespace

TEST_CASE("a file's own metadata is read") {
    const TempFolder folder;
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata("nobody"));
    openvdb::io::File(folder.file("ball.vdb")).write({ball()}, metadata);
    const openvdb::MetaMap read = readFileMetadata(folder.file("ball.vdb"));
    CHECK(read.metaValue<std::string>("creator") == "nobody");
    CHECK_THROWS_AS(readFileMetadata(folder.file("none.vdb")), FileError);
}

TEST_CASE("a file cut short anywhere is an error") {
    const TempFolder folder;
    for (const std::uint32_t compression :
         {std::uint32_t(openvdb::io::COMPRESS_NONE), openvdb::io::Archive::DEFAULT_COMPRESSION_FLAGS}) {
        write(folder.file("whole.vdb"), {ball()}, compression);
        REQUIRE(isBall(readGrid(folder.file("whole.vdb"))));
        std::ifstream stream(folder.file("whole.vdb"), std::ios::binary);
        const std::string whole{std::istreambuf_iterator<char>(stream), {}};
        for (std::size_t part = 0; part < 100; ++part) {
            const std::size_t size = part * (whole.size() - 1) / 99;
            std::ofstream(folder.file("part.vdb"), std::ios::binary) << whole.substr(0, size);
            for (const bool delayLoad : {false, true}) {
                CHECK_THROWS_AS(readGrid(folder.file("part.vdb"), "", delayLoad), FileError);
            }
        }
    }
}

TEST_CASE("a file without offsets is read") {
    const TempFolder folder;
    {
        std::ofstream stream(folder.file("stream.vdb"), std::ios::binary);
        openvdb::io::Stream(stream).write({openvdb::Vec3SGrid::create(), ball()});
    }
    CHECK(isBall(readGrid(folder.file("stream.vdb"))));
    CHECK(isBall(readGrid(folder.file("stream.vdb"), "ball", /*delayLoad=*/true)));
}

TEST_CASE("grids that share a tree are read each") {
    const TempFolder folder;
    const auto grid = ball();
    const auto twin = openvdb::FloatGrid::create(grid->treePtr());
    twin->setName("twin");
    write(folder.file("twins.vdb"), {twin, grid});
    CHECK(isBall(readGrid(folder.file("twins.vdb"), "ball")));
    const auto read = readGrid(folder.file("twins.vdb"), "twin");
    CHECK(read->getName() == "twin");
    CHECK(read->activeVoxelCount() == grid->activeVoxelCount());
}

TEST_CASE("a grid of a type that OpenVDB does not know spoils no other") {
    using OddGrid = openvdb::Grid<openvdb::tree::Tree3<float, 4, 3>::Type>;
    const TempFolder folder;
    const auto odd = OddGrid::create();
    odd->setName("odd");
    write(folder.file("odd.vdb"), {odd, ball()});
    for (const bool delayLoad : {false, true}) {
        CHECK(isBall(readGrid(folder.file("odd.vdb"), "", delayLoad)));
        CHECK_THROWS_AS(readGrid(folder.file("odd.vdb"), "odd", delayLoad), UnsupportedGrid);
    }
}

TEST_CASE("heads of grids tell what they are, and no tree is read") {
    const TempFolder folder;
    const auto other = openvdb::Vec3SGrid::create();
    other->setName("v");
    const std::string path = folder.file("grids.vdb");
    write(path, {ball(), other, other->deepCopy()});
    const auto heads = readHeads(path);
    REQUIRE(heads.size() == 3);
    CHECK(heads[0].name == "ball");
    CHECK(heads[0].type == openvdb::FloatGrid::gridType());
    CHECK(heads[0].grid->transform() == ball()->transform());
    CHECK(heads[0].grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    CHECK(heads[0].grid->activeVoxelCount() == 0);
    const auto count =
        heads[0].grid->getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_VOXEL_COUNT);
    REQUIRE(count);
    CHECK(count->value() == std::int64_t(ball()->activeVoxelCount()));
    CHECK(heads[1].name == "v[0]");
    CHECK(heads[2].name == "v[1]");
    for (const auto& head : heads) CHECK(readGrid(path, head.name)->type() == head.type);
    CHECK_THROWS_AS(readHeads(folder.file("missing.vdb")), FileError);
}

TEST_CASE("scalar grids are listed by the names that find them") {
    const TempFolder folder;
    const std::string path = folder.file("grids.vdb");
    const auto named = [](const std::string& name) {
        const auto grid = ball();
        grid->setName(name);
        return grid;
    };
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("vel");
    write(path, {named("b"), vectors, named("a"), named("b"), named(""), openvdb::DoubleGrid::create()});
    const std::vector<std::string> names = scalarGrids(path);
    CHECK(names == std::vector<std::string>{"b[0]", "a", "b[1]", "[0]", "[1]"});
    for (const std::string& name : names) CHECK(readGrid(path, name));
    write(path, {vectors});
    CHECK_THROWS_AS(scalarGrids(path), UnsupportedGrid);
    CHECK_THROWS_AS(scalarGrids(folder.file("absent.vdb")), FileError);
}
