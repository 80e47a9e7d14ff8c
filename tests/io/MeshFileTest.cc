/// @file MeshFileTest.cc
/// The sizes that MeshFile announces, and what becomes of meshes that do not keep to their totals. The
/// contents of the files are read back by tests/cli and tests/formats.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/MeshFile.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace {

using namespace vdbtet;
using test::TempFolder;

MeshTotals counts(std::int64_t points, std::int64_t tets) {
    MeshTotals totals;
    totals.points = points;
    totals.tets = tets;
    return totals;
}

/// Separate unit tets.
MeshTotals totalsOf(std::int64_t tets, bool float32) {
    MeshTotals totals = counts(4 * tets, tets);
    totals.float32Suffices = float32;
    return totals;
}

/// With fields of both numbers of components at the points and in the tets.
MeshTotals withFields(MeshTotals totals) {
    totals.pointFields = {{"heat", 1}, {"vel", 3}};
    totals.cellFields = {{"vel", 3}, {"heat", 1}};
    return totals;
}

std::vector<float> valuesFrom(std::int64_t first, std::int64_t count) {
    std::vector<float> values;
    for (std::int64_t i = first; i < first + count; ++i) values.push_back(-1.0f / float(i + 1));
    return values;
}

/// Hand the tets [firstTet, firstTet + tets) to a sink, with the fields if asked.
void give(MeshSink& sink, std::int64_t firstTet, std::int64_t tets, bool fields = false) {
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
    std::vector<std::vector<float>> values;
    if (fields) {
        for (const int components : {1, 3}) {
            values.push_back(
                valuesFrom(components * chunk.firstPoint, components * std::int64_t(points.size())));
            chunk.pointFields.emplace_back(values.back().data(), values.back().size());
        }
        for (const int components : {3, 1}) {
            values.push_back(valuesFrom(components * firstTet, components * tets));
            chunk.cellFields.emplace_back(values.back().data(), values.back().size());
        }
    }
    sink.chunk(chunk);
}

std::string contents(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::filesystem::directory_iterator filesAt(const TempFolder& folder) {
    return std::filesystem::directory_iterator(std::filesystem::path(folder.file("x")).parent_path());
}

std::ptrdiff_t filesIn(const TempFolder& folder) { return std::distance(filesAt(folder), {}); }

/// Write tets in chunks that end before the tets @a ends, the last one first if @a backwards.
/// @return the contents of the files, by their names
std::map<std::string, std::string> filesOf(const std::string& format, const MeshTotals& totals,
                                           const std::vector<std::int64_t>& ends, bool backwards = false,
                                           int compression = 0) {
    const TempFolder folder;
    {
        MeshFile writer(folder.file("mesh"), format, {compression, {}});
        CHECK(writer.begin(totals));
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const std::size_t k = backwards ? ends.size() - 1 - i : i;
            const std::int64_t begin = k == 0 ? 0 : ends[k - 1];
            give(writer, begin, ends[k] - begin, !totals.pointFields.empty());
        }
        writer.end();
    }
    std::map<std::string, std::string> files;
    for (const auto& entry : filesAt(folder))
        files[entry.path().filename().string()] = contents(entry.path().string());
    return files;
}

} // namespace

TEST_CASE("a file of any format has the size announced") {
    for (const MeshFormat& format : meshFormats()) {
        for (const std::int64_t tets : {0, 1, 2, 3, 70000}) {
            for (const bool float32 : {false, true}) {
                CAPTURE(format.name, tets, float32);
                const MeshTotals totals = totalsOf(tets, float32);
                std::uint64_t bytes = 0;
                for (const auto& [name, content] : filesOf(format.name, totals, {tets / 2, tets}))
                    bytes += content.size();
                CHECK(bytes == MeshFile::size("mesh", totals, format.name));
            }
        }
    }
}

TEST_CASE("a file of any format does not depend on its chunks and their order") {
    for (const MeshFormat& format : meshFormats()) {
        for (const bool float32 : {false, true}) {
            CAPTURE(format.name, float32);
            const MeshTotals totals = totalsOf(1000, float32);
            const auto whole = filesOf(format.name, totals, {1000});
            const std::vector<std::int64_t> ends = {1, 2, 3, 3, 300, 301, 998, 999, 1000, 1000};
            CHECK(filesOf(format.name, totals, ends) == whole);
            CHECK(filesOf(format.name, totals, ends, true) == whole);
        }
    }
}

TEST_CASE("fields take the room announced, and do not depend on chunks and their order") {
    for (const MeshFormat& format : meshFormats()) {
        CAPTURE(format.name);
        for (const std::int64_t tets : {1, 2, 3, 1000}) {
            const MeshTotals totals = withFields(totalsOf(tets, true));
            if (!format.holdsFields) {
                CHECK_THROWS_AS(MeshFile::size("mesh", totals, format.name), BadOption);
                CHECK_THROWS_AS(MeshFile::requireFields(format), BadOption);
                continue;
            }
            const auto whole = filesOf(format.name, totals, {tets});
            std::uint64_t bytes = 0;
            for (const auto& [name, content] : whole) bytes += content.size();
            CHECK(bytes == MeshFile::size("mesh", totals, format.name));
            CHECK(bytes > MeshFile::size("mesh", totalsOf(tets, true), format.name));
            std::vector<std::int64_t> ends = {tets / 3, tets / 2, tets / 2 + tets / 7, tets, tets};
            CHECK(filesOf(format.name, totals, ends) == whole);
            CHECK(filesOf(format.name, totals, ends, true) == whole);
        }
    }
}

TEST_CASE("a compressed file is no larger than announced, and the same every time") {
    for (const MeshFormat& format : meshFormats()) {
        if (!format.compresses) continue;
        for (const std::int64_t tets : {0, 1, 70000}) {
            for (const int level : {1, 9}) {
                CAPTURE(format.name, tets, level);
                const MeshTotals totals = totalsOf(tets, false);
                const std::vector<std::int64_t> ends = {0, tets / 70, tets / 2, tets, tets};
                const auto files = filesOf(format.name, totals, ends, false, level);
                CHECK(files.at("mesh").size() <= MeshFile::size("mesh", totals, format.name, {level}));
                CHECK((filesOf(format.name, totals, ends, false, level) == files));
            }
        }
    }
}

TEST_CASE("a field's tags in msh files are of 32 bits, and larger meshes are refused") {
    constexpr std::int64_t kMaxInt32 = (std::int64_t(1) << 31) - 1;
    CHECK_NOTHROW(MeshFile::size("mesh.msh", withFields(counts(kMaxInt32, kMaxInt32))));
    CHECK_THROWS_AS(MeshFile::size("mesh.msh", withFields(counts(kMaxInt32 + 1, 1))), TooLarge);
    CHECK_THROWS_AS(MeshFile::size("mesh.msh", withFields(counts(1, kMaxInt32 + 1))), TooLarge);
}

TEST_CASE("options of USD are refused by other formats") {
    UsdOptions usd;
    usd.surface = true;
    for (const MeshFormat& format : meshFormats()) {
        CAPTURE(format.name);
        const TempFolder folder;
        if (format.takesUsdOptions) {
            const auto size = [&](const std::optional<UsdOptions>& options) {
                return MeshFile::size("mesh", totalsOf(3, true), format.name, {0, options});
            };
            CHECK(size(usd) > size(UsdOptions()));
            CHECK(size(UsdOptions()) == size({}));
        } else {
            CHECK_THROWS_AS(MeshFile(folder.file("mesh"), format.name, {0, usd}), BadOption);
            CHECK_THROWS_AS(MeshFile::size("mesh", totalsOf(3, true), format.name, {0, usd}), BadOption);
            CHECK(filesIn(folder) == 0);
        }
    }
}

TEST_CASE("formats without compression, and levels that there are not, are refused") {
    CHECK_THROWS_AS(MeshFile("mesh.vtk", "", {1}), BadOption);
    CHECK_THROWS_AS(MeshFile::size("mesh.npz", totalsOf(1, true), "", {1}), BadOption);
    CHECK_THROWS_AS(MeshFile::formatOf("mesh.vtu", "vtu-inline", {1}), BadOption);
    for (const int level : {-1, 10}) CHECK_THROWS_AS(MeshFile("mesh.vtu", "", {level}), BadOption);
}

TEST_CASE("indices of a vtkhdf file take 64 bits only where 32 are too few") {
    const auto bytesPerTet = [](std::int64_t points, std::int64_t tets) {
        const MeshTotals totals = counts(points, tets);
        return (double(MeshFile::size("mesh.vtkhdf", totals)) - 24.0 * double(points)) / double(tets);
    };
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK(bytesPerTet(1000, two31 / 4 - 1) == Approx(16 + 4 + 1));
    CHECK(bytesPerTet(1000, two31 / 4) == Approx(32 + 8 + 1));
    CHECK(bytesPerTet(two31 + 1, two31 / 8) == Approx(32 + 8 + 1));
    CHECK(bytesPerTet(two31, 1000 * two31) == Approx(32 + 8 + 1));
}

TEST_CASE("indices of a vtu file take 64 bits only where 32 are too few") {
    const auto bytesPerTet = [](std::int64_t points, std::int64_t tets) {
        const MeshTotals totals = counts(points, tets);
        return (double(MeshFile::size("mesh.vtu", totals)) - 24.0 * double(points)) / double(tets);
    };
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK(bytesPerTet(1000, two31 / 4 - 1) == Approx(16 + 4 + 1));
    CHECK(bytesPerTet(1000, two31 / 4) == Approx(16 + 8 + 1));
    CHECK(bytesPerTet(two31, two31 / 4) == Approx(16 + 8 + 1));
    CHECK(bytesPerTet(two31 + 1, two31 / 4) == Approx(32 + 8 + 1));
}

TEST_CASE("a legacy vtk file is of the new version only where the old one cannot hold the mesh") {
    const auto bytesPerTet = [](std::int64_t points, std::int64_t tets) {
        const MeshTotals totals = counts(points, tets);
        return (double(MeshFile::size("mesh.vtk", totals)) - 24.0 * double(points)) / double(tets);
    };
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK(bytesPerTet(1000, two31 / 5) == Approx(4 + 16 + 4));
    CHECK(bytesPerTet(1000, two31 / 5 + 1) == Approx(8 + 32 + 4));
    CHECK(bytesPerTet(two31, two31 / 5) == Approx(4 + 16 + 4));
    CHECK(bytesPerTet(two31 + 1, two31 / 5) == Approx(8 + 32 + 4));
}

TEST_CASE("positions and ids of a meshb file take 64 bits only where 32 are too few") {
    const auto size = [](std::int64_t points, std::int64_t tets) {
        return std::int64_t(MeshFile::size("mesh.meshb", counts(points, tets)));
    };
    constexpr std::int64_t kMaxInt32 = (std::int64_t(1) << 31) - 1, kMostTets = (kMaxInt32 - 52 - 28) / 20;
    CHECK(size(1, kMostTets) == 52 + 28 + 20 * kMostTets);
    CHECK(size(1, kMostTets + 1) == 68 + 28 + 20 * (kMostTets + 1));
    CHECK(size(kMaxInt32, kMaxInt32) == 68 + 28 * kMaxInt32 + 20 * kMaxInt32);
    CHECK(size(kMaxInt32 + 1, 1) == 76 + 32 * (kMaxInt32 + 1) + 40);
    CHECK(size(1, kMaxInt32 + 1) == 76 + 32 + 40 * (kMaxInt32 + 1));
}

TEST_CASE("an msh22 file is refused where its ids would need more than 32 bits") {
    const auto size = [](std::int64_t points, std::int64_t tets) {
        return MeshFile::size("mesh.msh", counts(points, tets), "msh22");
    };
    constexpr std::int64_t kMaxInt32 = (std::int64_t(1) << 31) - 1;
    CHECK(size(kMaxInt32, kMaxInt32) > 0);
    CHECK_THROWS_AS(size(kMaxInt32 + 1, 1), TooLarge);
    CHECK_THROWS_AS(size(1, kMaxInt32 + 1), TooLarge);
}

TEST_CASE("the old file stands until the new one is whole") {
    const auto extension = GENERATE(as<std::string>(), ".vtu", ".vtkhdf");
    const int compression = GENERATE(0, 1);
    const TempFolder folder;
    const std::string path = folder.file("mesh" + extension);
    std::ofstream(path) << "old";

    SECTION("a run that ends before it begins") { const MeshFile writer(path, "", {compression}); }
    SECTION("a run that ends early") {
        MeshFile writer(path, "", {compression});
        writer.begin(totalsOf(100000, true));
        give(writer, 0, 90000);
    }
    SECTION("fewer tets than announced") {
        MeshFile writer(path, "", {compression});
        writer.begin(totalsOf(10, true));
        give(writer, 0, 5);
        CHECK_THROWS_AS(writer.end(), FileError);
    }
    SECTION("more tets than announced") {
        MeshFile writer(path, "", {compression});
        writer.begin(totalsOf(10, true));
        CHECK_THROWS_AS(give(writer, 0, 11), FileError);
    }
    CHECK(contents(path) == "old");
    CHECK(filesIn(folder) == 1);
}
