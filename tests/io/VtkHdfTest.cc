/// @file VtkHdfTest.cc
/// The arrays of .vtkhdf files, read back by the HDF5 library, and what becomes of errors on the way through
/// it. That VTK reads the files is tested in tests/formats.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include "io/Hdf5File.h"
#include "io/formats/VtkHdfSchema.h"

#include <vdbtet/Errors.h>
#include <vdbtet/MeshFile.h>

#include <hdf5.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace {

using namespace vdbtet;
using test::TempFolder;

/// A mesh of no shape, with fields of which each value tells its place.
struct Mesh {
    explicit Mesh(std::int64_t tetCount) : points(std::size_t(tetCount)), tets(std::size_t(tetCount)) {
        totals.points = totals.tets = tetCount;
        totals.pointFields = {{"a/b", 3}, {"a_b", 1}, {".", 1}};
        totals.cellFields = {{"a_b", 1}, {std::string(10000, 'x'), 3}};
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto id = std::int64_t(i);
            points[i] = {double(i), 0.1 * double(i), -1.0};
            tets[i] = {id, (id + 1) % tetCount, (7 * id) % tetCount, (id * id) % tetCount};
        }
        values.resize(3 * points.size());
        std::iota(values.begin(), values.end(), 0.0f);
    }

    /// Write it in chunks of so many points and tets.
    void write(MeshSink& sink, std::size_t perChunk) const {
        sink.begin(totals);
        for (std::size_t first = 0; first < tets.size(); first += perChunk) {
            const std::size_t count = std::min(perChunk, tets.size() - first);
            MeshChunk chunk;
            chunk.firstPoint = chunk.firstTet = std::int64_t(first);
            chunk.points = {&points[first], count};
            chunk.tets = {&tets[first], count};
            for (const MeshField& field : totals.pointFields)
                chunk.pointFields.push_back(view(field, first, count));
            for (const MeshField& field : totals.cellFields)
                chunk.cellFields.push_back(view(field, first, count));
            sink.chunk(chunk);
        }
        sink.end();
    }

    ArrayView<float> view(const MeshField& field, std::size_t first, std::size_t count) const {
        const auto components = std::size_t(field.components);
        return {&values[first * components], count * components};
    }

    MeshTotals totals;
    std::vector<openvdb::Vec3d> points;
    std::vector<Tet> tets;
    std::vector<float> values;
};

template <typename T>
std::vector<T> read(hid_t file, const std::string& path, hid_t type) {
    const hid_t dataset = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
    REQUIRE(dataset >= 0);
    const hid_t space = H5Dget_space(dataset);
    std::vector<T> values(std::size_t(H5Sget_simple_extent_npoints(space)));
    CHECK(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
}

void checkHolds(const std::string& path, const Mesh& mesh) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(file >= 0);
    std::vector<double> points;
    for (const auto& point : mesh.points)
        points.insert(points.end(), point.asPointer(), point.asPointer() + 3);
    std::vector<std::int64_t> ids, offsets = {0};
    for (const Tet& tet : mesh.tets) {
        ids.insert(ids.end(), tet.begin(), tet.end());
        offsets.push_back(offsets.back() + 4);
    }
    const auto floats = [&](const std::string& name) {
        return read<float>(file, "VTKHDF/" + name, H5T_NATIVE_FLOAT);
    };
    const std::vector<float>& vectors = mesh.values;
    const std::vector<float> scalars(vectors.begin(), vectors.begin() + std::ptrdiff_t(mesh.tets.size()));
    // Not by Catch, which would print millions of numbers.
    CHECK((read<double>(file, "VTKHDF/Points", H5T_NATIVE_DOUBLE) == points));
    CHECK((read<std::int64_t>(file, "VTKHDF/Connectivity", H5T_NATIVE_INT64) == ids));
    CHECK((read<std::int64_t>(file, "VTKHDF/Offsets", H5T_NATIVE_INT64) == offsets));
    CHECK((read<char>(file, "VTKHDF/Types", H5T_NATIVE_CHAR) ==
           std::vector<char>(mesh.tets.size(), kVtkTetra)));
    CHECK((floats("PointData/a_b") == vectors));
    CHECK((floats("PointData/a_b_") == scalars));
    CHECK((floats("PointData/._") == scalars));
    CHECK((floats("CellData/a_b") == scalars));
    CHECK((floats("CellData/" + std::string(10000, 'x')) == vectors));
    for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
        const std::int64_t expected =
            count == std::string("NumberOfConnectivityIds") ? 4 * mesh.totals.tets : mesh.totals.tets;
        CHECK((read<std::int64_t>(file, std::string("VTKHDF/") + count, H5T_NATIVE_INT64) ==
               std::vector<std::int64_t>{expected}));
    }
    H5Fclose(file);
}

/// Fails from a certain write on.
struct FailingStorage final : Hdf5Storage {
    explicit FailingStorage(int writes) : left(writes) {}
    void write(std::uint64_t offset, const void* data, std::size_t size) override {
        if (--left < 0) throw std::runtime_error("no space");
        image.write(offset, data, size);
    }
    void read(std::uint64_t offset, void* data, std::size_t size) override { image.read(offset, data, size); }

    int left;
    Hdf5Image image;
};

/// Make a file as a compressed mesh does.
/// @return its size
std::uint64_t makeFile(Hdf5Storage& storage) {
    MeshTotals totals;
    totals.points = totals.tets = 100000;
    Hdf5File file(storage, "mesh.vtkhdf");
    const auto arrays = addVtkHdf(file, totals, 1024);
    for (const VtkHdfArray& added : arrays) {
        for (std::uint64_t row = 0; row < 90 * added.shape.chunkRows; row += added.shape.chunkRows) {
            file.writeChunk(added.id, added.shape, row, "not really deflated", 19);
        }
    }
    return file.close();
}

} // namespace

TEST_CASE("arrays of a vtkhdf file are whole whatever the chunks") {
    // Blocks of 256 kB are those of compression.
    for (const std::int64_t tets : {1, 2, 1000, 70000}) {
        for (const int compression : {0, 1, 9}) {
            for (const std::size_t perChunk : {777, 100000}) {
                CAPTURE(tets, compression, perChunk);
                const TempFolder folder;
                const std::string path = folder.file("mesh.vtkhdf");
                const Mesh mesh(tets);
                MeshFile writer(path, "", {compression, {}});
                mesh.write(writer, perChunk);
                CHECK(writer.bytes() == std::filesystem::file_size(path));
                checkHolds(path, mesh);
            }
        }
    }
}

TEST_CASE("a vtkhdf file that cannot be written fails with the storage's own error") {
    FailingStorage whole(1 << 30);
    CHECK(makeFile(whole) > 4 * 90 * 19);
    const int writes = (1 << 30) - whole.left;
    CHECK(writes > 4 * 90);
    for (int most = 0; most < writes; ++most) {
        CAPTURE(most);
        FailingStorage storage(most);
        CHECK_THROWS_AS(makeFile(storage), std::runtime_error);
    }
}

TEST_CASE(
    "what the HDF5 library refuses is an error that names the file, and the program's handler is kept") {
    H5E_auto2_t before = nullptr, after = nullptr;
    void *dataBefore = nullptr, *dataAfter = nullptr;
    H5Eget_auto2(H5E_DEFAULT, &before, &dataBefore);
    CHECK(before);
    {
        Hdf5Image image;
        Hdf5File file(image, "mesh.vtkhdf");
        file.addGroup("same");
        CHECK_THROWS_WITH(file.addGroup("same"),
                          Catch::Matchers::StartsWith("cannot write mesh.vtkhdf: HDF5: "));
        CHECK_THROWS_AS(file.addGroup("same"), FileError);
    }
    H5Eget_auto2(H5E_DEFAULT, &after, &dataAfter);
    CHECK(after == before);
    CHECK(dataAfter == dataBefore);
}
