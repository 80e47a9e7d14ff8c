/// @file MeshFileTest.cc
/// The sizes that MeshFile announces, and what becomes of meshes that do not keep to their totals. The
/// content of the file is read back by tests/cli.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/MeshFile.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

using namespace vdbtet;
using test::TempFolder;

/// Separate unit tets.
MeshTotals totalsOf(std::int64_t tets, bool float32) {
    MeshTotals totals;
    totals.points = 4 * tets;
    totals.tets = tets;
    totals.float32Suffices = float32;
    return totals;
}

/// Hand the tets [firstTet, firstTet + tets) to a sink.
void give(MeshSink& sink, std::int64_t firstTet, std::int64_t tets) {
    std::vector<openvdb::Vec3d> points;
    std::vector<Tet> ids;
    for (std::int64_t i = firstTet; i < firstTet + tets; ++i) {
        const auto x = double(i);
        for (const auto& p : {openvdb::Vec3d(x, 0, 0), openvdb::Vec3d(x + 1, 0, 0), openvdb::Vec3d(x, 1, 0),
                              openvdb::Vec3d(x, 0, 1)}) {
            points.push_back(p);
        }
        ids.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
    }
    MeshChunk chunk;
    chunk.firstTet = firstTet;
    chunk.firstPoint = 4 * firstTet;
    chunk.points = {points.data(), points.size()};
    chunk.tets = {ids.data(), ids.size()};
    sink.chunk(chunk);
}

std::string contents(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::ptrdiff_t filesIn(const TempFolder& folder) {
    const auto directory = std::filesystem::path(folder.file("x")).parent_path();
    return std::distance(std::filesystem::directory_iterator(directory), {});
}

} // namespace

TEST_CASE("a vtu file has the size announced") {
    const TempFolder folder;
    for (const std::int64_t tets : {0, 1, 70000}) {
        for (const bool float32 : {false, true}) {
            const MeshTotals totals = totalsOf(tets, float32);
            MeshFile writer(folder.file("mesh.vtu"));
            CHECK(writer.begin(totals));
            const std::int64_t some = tets / 2;
            give(writer, 0, some);
            give(writer, some, tets - some);
            writer.end();
            CHECK(std::filesystem::file_size(folder.file("mesh.vtu")) == MeshFile::size("mesh.vtu", totals));
        }
    }
    CHECK(filesIn(folder) == 1);
}

TEST_CASE("a vtu file does not depend on the order of its chunks") {
    const TempFolder folder;
    const MeshTotals totals = totalsOf(1000, true);
    const std::vector<std::int64_t> begins = {0, 1, 300, 999};
    for (const bool backwards : {false, true}) {
        MeshFile writer(folder.file(backwards ? "b.vtu" : "a.vtu"));
        writer.begin(totals);
        for (std::size_t i = 0; i < begins.size(); ++i) {
            const std::size_t k = backwards ? begins.size() - 1 - i : i;
            give(writer, begins[k], (k + 1 < begins.size() ? begins[k + 1] : totals.tets) - begins[k]);
        }
        writer.end();
    }
    CHECK(contents(folder.file("a.vtu")) == contents(folder.file("b.vtu")));
}

TEST_CASE("indices of a vtu file take 64 bits only where 32 are too few") {
    const auto bytesPerTet = [](std::int64_t points, std::int64_t tets) {
        MeshTotals totals;
        totals.points = points;
        totals.tets = tets;
        return (double(MeshFile::size("mesh.vtu", totals)) - 24.0 * double(points)) / double(tets);
    };
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK(bytesPerTet(1000, two31 / 4 - 1) == Approx(16 + 4 + 1));
    CHECK(bytesPerTet(1000, two31 / 4) == Approx(16 + 8 + 1));
    CHECK(bytesPerTet(two31, two31 / 4) == Approx(16 + 8 + 1));
    CHECK(bytesPerTet(two31 + 1, two31 / 4) == Approx(32 + 8 + 1));
}

TEST_CASE("the old vtu file stands until the new one is whole") {
    const TempFolder folder;
    const std::string path = folder.file("mesh.vtu");
    std::ofstream(path) << "old";

    SECTION("a run that ends early") {
        MeshFile writer(path);
        writer.begin(totalsOf(10, true));
        give(writer, 0, 5);
    }
    SECTION("fewer tets than announced") {
        MeshFile writer(path);
        writer.begin(totalsOf(10, true));
        give(writer, 0, 5);
        CHECK_THROWS_AS(writer.end(), FileError);
    }
    SECTION("more tets than announced") {
        MeshFile writer(path);
        writer.begin(totalsOf(10, true));
        CHECK_THROWS_AS(give(writer, 0, 11), FileError);
    }
    CHECK(contents(path) == "old");
    CHECK(filesIn(folder) == 1);
}
