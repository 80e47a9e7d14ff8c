/// @file fuzz_vdb.cc
/// Bytes are a .vdb file. It is read or refused, and what is read is meshed or refused.
///
/// OpenVDB writes beyond its buffers on some damaged files (SECURITY.md), which is why vdb_tet reads in a
/// child process. So does this: what ends inside OpenVDB's library while it reads is counted, and is no
/// finding.
#include "fuzz/ForkedRun.h"
#include "fuzz/MeshFault.h"

#include <vdbtet/Errors.h>
#include <vdbtet/GridFile.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/openvdb.h>

#include <tbb/global_control.h>

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace {

using namespace vdbtet;
using test::Outcome;
using test::Stage;

/// Counts outcomes, and tells them at the end.
class Counts {
public:
    ~Counts() {
        std::fprintf(stderr, "%lld meshed, %lld refused, %lld ended inside OpenVDB\n", mCounts[0], mCounts[1],
                     mCounts[3]);
    }
    void add(Outcome outcome) { ++mCounts[std::size_t(outcome)]; }

private:
    std::array<long long, 4> mCounts{};
};

/// A file in memory.
class File {
public:
    File(const std::uint8_t* data, std::size_t size) : mFile(memfd_create("fuzzed.vdb", MFD_CLOEXEC)) {
        if (mFile >= 0 && write(mFile, data, size) == ssize_t(size)) return;
        std::perror("cannot make a file");
        std::abort();
    }
    ~File() { close(mFile); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(mFile); }

private:
    int mFile;
};

Outcome readAndMesh(const std::string& path, const std::function<void(Stage)>& enter) {
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    readHeads(path);
    const std::string name = scalarGrids(path).front();
    const auto grid = readGrid(path, name);
    readFields(path, {name});
    enter(Stage::Working);
    Options options;
    options.voxels = 2.0;
    options.maxSurfaceTiles = 500;
    TetMesh mesh;
    const Report report = volumeToTets(*grid, mesh, options);
    const std::string fault = test::meshFault(mesh, report);
    if (fault.empty()) return Outcome::Done;
    std::fprintf(stderr, "the mesh has %s\n", fault.c_str());
    return Outcome::Finding;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Counts counts;
    openvdb::initialize();
    const File file(data, size);
    counts.add(test::runForked([&](const std::function<void(Stage)>& enter) {
        try {
            return readAndMesh(file.path(), enter);
        } catch (const Error& error) {
            if (error.what()[0] != '\0') return Outcome::Refused;
        } catch (const std::exception& other) {
            std::fprintf(stderr, "not an exception of this library: %s\n", other.what());
        }
        return Outcome::Finding;
    }));
    return 0;
}
