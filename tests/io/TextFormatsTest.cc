/// @file TextFormatsTest.cc
/// What formats of padded text and the .npz promise of their files; their content is read back by
/// tests/formats.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/MeshFile.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace {

using namespace vdbtet;
using test::TempFolder;

constexpr std::int64_t kBillion = 1000000000;

const std::vector<std::string> kFormats = {"tetgen", "npz", "inp", "geo", "usda"};

/// Separate tets, some of whose coordinates take all the digits that there are.
class Tets {
public:
    Tets(std::int64_t tets, bool float32) {
        mTotals.points = 4 * tets;
        mTotals.tets = tets;
        mTotals.triangles = 4 * tets;
        mTotals.float32Suffices = float32;
        for (std::int64_t i = 0; i < tets; ++i) {
            for (int corner = 0; corner < 4; ++corner) {
                mPoints.emplace_back(corner == 1 ? -1.1754943508222875e-38 : double(i) / 3.0,
                                     corner == 2 ? -1.0 / 3e6 : 0.0, corner == 3 ? -2e9 / 3.0 : 0.0);
                mTotals.bounds.expand(mPoints.back());
            }
            const std::int64_t a = 4 * i, b = a + 1, c = a + 2, d = a + 3;
            mTets.push_back({a, b, c, d});
            mTriangles.insert(mTriangles.end(), {{b, c, d}, {a, d, c}, {a, b, d}, {a, c, b}});
        }
    }

    const MeshTotals& totals() const { return mTotals; }

    void give(MeshSink& sink, std::int64_t first, std::int64_t count) const {
        const auto at = std::size_t(first), some = std::size_t(count);
        MeshChunk chunk;
        chunk.firstPoint = chunk.firstTriangle = 4 * first;
        chunk.firstTet = first;
        chunk.points = {mPoints.data() + 4 * at, 4 * some};
        chunk.tets = {mTets.data() + at, some};
        if (sink.wants().triangles) chunk.triangles = {mTriangles.data() + 4 * at, 4 * some};
        sink.chunk(chunk);
    }

private:
    MeshTotals mTotals;
    std::vector<openvdb::Vec3d> mPoints;
    std::vector<Tet> mTets;
    std::vector<Triangle> mTriangles;
};

/// Write them in chunks that begin at these, in this order.
void write(const std::string& path, const std::string& format, const Tets& tets,
           const std::vector<std::int64_t>& begins) {
    std::vector<std::int64_t> ends = begins;
    ends.push_back(tets.totals().tets);
    std::sort(ends.begin(), ends.end());
    MeshFile writer(path, format);
    writer.begin(tets.totals());
    for (const std::int64_t begin : begins) {
        tets.give(writer, begin, *std::upper_bound(ends.begin(), ends.end(), begin) - begin);
    }
    writer.end();
}

/// The files in a folder by name.
std::vector<std::pair<std::string, std::string>> contents(const TempFolder& folder) {
    std::vector<std::pair<std::string, std::string>> files;
    const auto directory = std::filesystem::path(folder.file("x")).parent_path();
    for (const auto& entry : std::filesystem::directory_iterator(directory)) {
        std::ifstream stream(entry.path(), std::ios::binary);
        files.emplace_back(entry.path().filename().string(),
                           std::string(std::istreambuf_iterator<char>(stream), {}));
    }
    std::sort(files.begin(), files.end());
    return files;
}

MeshTotals totalsOf(std::int64_t points, std::int64_t tets) {
    MeshTotals totals;
    totals.points = points;
    totals.tets = tets;
    totals.triangles = tets;
    return totals;
}

} // namespace

TEST_CASE("files of simulation formats have the size announced") {
    for (const std::string& format : kFormats) {
        for (const std::int64_t tets : {2, 300, 20000}) {
            for (const bool float32 : {false, true}) {
                CAPTURE(format, tets, float32);
                const TempFolder folder;
                const Tets mesh(tets, float32);
                write(folder.file("mesh.x"), format, mesh, {0, tets / 2});
                std::uint64_t bytes = 0;
                for (const auto& file : contents(folder)) bytes += file.second.size();
                CHECK(bytes == MeshFile::size("mesh.x", mesh.totals(), format));
            }
        }
    }
}

TEST_CASE("files of simulation formats do not depend on the order of their chunks") {
    const Tets mesh(1000, true);
    for (const std::string& format : kFormats) {
        CAPTURE(format);
        const TempFolder forwards, backwards;
        write(forwards.file("mesh.x"), format, mesh, {0, 1, 300, 999});
        write(backwards.file("mesh.x"), format, mesh, {999, 300, 0, 1});
        CHECK(contents(forwards) == contents(backwards));
    }
}

TEST_CASE("a mesh for TetGen is three files") {
    const TempFolder folder;
    const Tets mesh(1, true);
    write(folder.file("mesh.ele"), {}, mesh, {0});
    const auto files = contents(folder);
    REQUIRE(files.size() == 3);
    CHECK(files[0].first == "mesh.ele");
    CHECK(files[0].second == "1 4 0\n1 1 2 3 4\n");
    CHECK(files[1].first == "mesh.face");
    CHECK(files[1].second == "4 1\n1 2 3 4 1\n2 1 4 3 1\n3 1 2 4 1\n4 1 3 2 1\n");
    CHECK(files[2].first == "mesh.node");
}

TEST_CASE("coordinates in text are read back as they were") {
    for (const bool float32 : {false, true}) {
        CAPTURE(float32);
        const TempFolder folder;
        write(folder.file("mesh.node"), {}, Tets(4, float32), {0});
        std::istringstream text(contents(folder).back().second);
        std::string line;
        std::getline(text, line);
        std::vector<double> values;
        for (std::int64_t id; text >> id;) {
            // Not by >>, which refuses numbers as small as these.
            for (int axis = 0; axis < 3 && text >> line; ++axis)
                values.push_back(std::strtod(line.c_str(), nullptr));
        }
        REQUIRE(values.size() == 4 * 4 * 3);
        const auto as = [float32](double value) { return float32 ? double(float(value)) : value; };
        CHECK(as(values[3]) == as(-1.1754943508222875e-38));
        CHECK(as(values[7]) == as(-1.0 / 3e6));
        CHECK(as(values[11]) == as(-2e9 / 3.0));
        CHECK(as(values[12]) == as(1.0 / 3.0));
    }
}

TEST_CASE("formats refuse meshes that are larger than their ids") {
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK_NOTHROW(MeshFile::size("mesh.usda", totalsOf(two31, 6 * kBillion)));
    CHECK_THROWS_AS(MeshFile::size("mesh.usda", totalsOf(two31 + 1, kBillion)), TooLarge);
    CHECK_NOTHROW(MeshFile::size("mesh.inp", totalsOf(kBillion / 5, kBillion - 1)));
    CHECK_THROWS_AS(MeshFile::size("mesh.inp", totalsOf(kBillion / 5, kBillion)), TooLarge);
    CHECK_THROWS_AS(MeshFile::size("mesh.inp", totalsOf(kBillion, kBillion / 5)), TooLarge);
    std::string message;
    try {
        MeshFile::size("mesh.inp", totalsOf(1, kBillion));
    } catch (const TooLarge& error) {
        message = error.what();
    }
    CHECK(message ==
          "the mesh has 1000000000 tets, but the format inp numbers no more than 999999999; write it "
          "as vtu");
}

TEST_CASE("indices of an npz file take 64 bits only where 32 are too few") {
    const auto bytesPerTet = [](std::int64_t points) {
        const std::int64_t tets = 6 * kBillion;
        return (double(MeshFile::size("mesh.npz", totalsOf(points, tets))) - 24.0 * double(points)) /
               double(tets);
    };
    const std::int64_t two31 = std::int64_t(1) << 31;
    CHECK(bytesPerTet(two31) == Approx(16));
    CHECK(bytesPerTet(two31 + 1) == Approx(32));
}
