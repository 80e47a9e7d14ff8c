// Whatever fails, wherever in a run: it ends in an exception that says so, leaves nothing, and the next run
// in the same process is as if nothing had been.
#include "faults/Faults.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/TempFolder.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>
#include <vdbtet/MeshFile.h>
#include <vdbtet/SurfaceFile.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <new>
#include <string>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

namespace fs = std::filesystem;

/// What a sink or an interrupter of the user's may throw.
struct Refusal : std::exception {
    const char* what() const noexcept override { return "refused"; }
};

/// Throws in the n-th task that asks.
struct ThrowingInterrupter final : openvdb::util::NullInterrupter {
    explicit ThrowingInterrupter(std::int64_t at) : n(at) {}
    bool wasInterrupted(int = -1) override {
        if (++asked == n) throw Refusal();
        return false;
    }

    std::int64_t n;
    std::atomic<std::int64_t> asked{0};
};

/// Passes a mesh on until the n-th chunk.
struct ThrowingSink final : MeshSink {
    ThrowingSink(MeshSink& to, std::int64_t at) : sink(to), n(at) {}
    bool begin(const MeshTotals& totals) override { return sink.begin(totals); }
    void chunk(const MeshChunk& chunk) override {
        if (++chunks == n) throw Refusal();
        sink.chunk(chunk);
    }
    void end() override { sink.end(); }
    bool concurrent() const override { return sink.concurrent(); }
    MeshWants wants() const override { return sink.wants(); }

    MeshSink& sink;
    std::int64_t n;
    std::atomic<std::int64_t> chunks{0};
};

/// Thin in places, so that there is something to repair and to flag, and thick in others.
openvdb::FloatGrid::Ptr shape() { return levelSet(gyroidBall({0.3, -0.2, 0.1}, 12.0, 13.0, 1.7)); }

struct Kind {
    const char* name;
    Options options;
};

std::vector<Kind> kinds() {
    Options plain, graded, between, optimized, third, all;
    graded.grade = true;
    between.voxels = 1.3;
    optimized.optimize = 30.0;
    third.tiger = 3;
    all.tiger = 3;
    all.optimize = 30.0;
    all.grade = true;
    all.voxels = 0.9;
    return {{"uniform", plain},       {"graded", graded}, {"between voxels", between},
            {"optimized", optimized}, {"third", third},   {"all", all}};
}

/// Run into a file, with a field.
void meshInto(const openvdb::FloatGrid& grid, const Options& options, const std::string& path,
              const std::string& format = "vtu", int compression = 0,
              openvdb::util::NullInterrupter* interrupter = nullptr, std::int64_t refusedChunk = 0) {
    FormatOptions how;
    how.compression = compression;
    MeshFile file(path, format, how);
    FieldOptions fields;
    if (MeshFile::formatOf(path, format).holdsFields) fields.boundaryFlag = true;
    FieldSampler sampler(file, fields);
    ThrowingSink sink(sampler, refusedChunk);
    volumeToTets(grid, sink, options, interrupter);
}

/// The files of a folder, whole.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        std::ifstream stream(entry.path(), std::ios_base::binary);
        files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(stream), {}};
    }
    return files;
}

std::string nameFor(const MeshFormat& format) {
    return "mesh" + (format.extensions.empty() ? ".any" : format.extensions[0]);
}

/// How a run ended.
enum class End { Whole, Error, NoMemory, Refused };

End endOf(const std::function<void()>& run) {
    try {
        run();
        return End::Whole;
    } catch (const Error&) {
        return End::Error;
    } catch (const std::bad_alloc&) {
        return End::NoMemory;
    } catch (const Refusal&) {
        return End::Refused;
    }
}

/// All of the first, and then ever fewer up to @a last.
std::vector<std::int64_t> spread(std::int64_t last) {
    std::vector<std::int64_t> values;
    for (std::int64_t n = 1; n < last; n += 1 + n / 4) values.push_back(n);
    values.push_back(last);
    return values;
}

/// Runs that write into a folder, and fail.
class Folder {
public:
    /// @param run  writes into the folder
    explicit Folder(std::function<void(const TempFolder&)> run) : mRun(std::move(run)) {
        mRun(mFolder);
        mWhole = contents(path());
        clear();
    }

    /// Fail once, and see what is left.
    /// @param fault  arms what fails, and counts how often it was asked
    template <typename MakeFault>
    void check(const MakeFault& makeFault, End expected, std::int64_t n) {
        CAPTURE(n);
        const std::map<std::string, std::string> before = contents(path());
        End end = End::Whole;
        const std::int64_t live = liveAllocations();
        {
            [[maybe_unused]] const auto fault = makeFault(n);
            end = endOf([&] { mRun(mFolder); });
        }
        CHECK(liveAllocations() == live);
        if (end == End::Whole) {
            // A thread less needed it, or someone could do without.
            CHECK(contents(path()) == mWhole);
        } else {
            CHECK(end == expected);
            CHECK(contents(path()) == before);
            ++mFailed;
        }
    }

    void checkWrites() {
        std::int64_t count = 0;
        {
            const FaultAt none(Fault::Write, 0);
            requireNextIsWhole();
            count = none.count();
        }
        REQUIRE(count > 1);
        const int before = mFailed;
        const auto values = spread(count);
        for (const std::int64_t n : values) {
            makeOld();
            check([](std::int64_t at) { return FaultAt(Fault::Write, at); }, End::Error, n);
        }
        CHECK(mFailed - before == int(values.size()));
        requireNextIsWhole();
    }

    void checkRename() {
        makeOld();
        check([](std::int64_t at) { return FaultAt(Fault::Rename, at); }, End::Error, 1);
        CHECK(contents(path()).begin()->second == "old");
        requireNextIsWhole();
    }

    void requireNextIsWhole() {
        mRun(mFolder);
        CHECK(contents(path()) == mWhole);
    }
    int failed() const { return mFailed; }
    const std::map<std::string, std::string>& whole() const { return mWhole; }

    void clear() {
        for (const auto& entry : fs::directory_iterator(path())) fs::remove_all(entry.path());
    }

private:
    /// Files that were there before.
    void makeOld() {
        for (const auto& [name, text] : mWhole) std::ofstream(path() / name) << "old";
    }

    fs::path path() const { return fs::path(mFolder.file("")).parent_path(); }

    TempFolder mFolder;
    std::function<void(const TempFolder&)> mRun;
    std::map<std::string, std::string> mWhole;
    int mFailed = 0;
};

} // namespace

TEST_CASE("any allocation may fail") {
    const auto grid = shape();
    for (const Kind& kind : kinds()) {
        CAPTURE(kind.name);
        const auto run = [&](const TempFolder& folder) {
            meshInto(*grid, kind.options, folder.file("mesh.vtu"));
        };
        Folder folder(run);
        std::int64_t count = 0;
        {
            const FaultAt none(Fault::Allocation, 0);
            folder.requireNextIsWhole();
            count = none.count();
        }
        folder.clear();
        REQUIRE(count > 100);
        const auto values = spread(count);
        for (const std::int64_t n : values)
            folder.check([](std::int64_t at) { return FaultAt(Fault::Allocation, at); }, End::NoMemory, n);
        CHECK(folder.failed() > int(values.size()) / 2);
        folder.requireNextIsWhole();
    }
}

TEST_CASE("any task may throw", "[threads]") {
    const auto grid = shape();
    for (const Kind& kind : kinds()) {
        CAPTURE(kind.name);
        std::int64_t at = 0, asked = 0;
        Folder folder([&](const TempFolder& temp) {
            ThrowingInterrupter interrupter(at);
            struct Count {
                ThrowingInterrupter& from;
                std::int64_t& to;
                ~Count() { to = from.asked; }
            } count{interrupter, asked};
            meshInto(*grid, kind.options, temp.file("mesh.vtu"), "vtu", 0, &interrupter);
        });
        REQUIRE(asked > 20);
        int failed = 0;
        for (const std::int64_t n : spread(asked - 1)) { // the last is asked when all is written
            at = n;
            folder.check([](std::int64_t) { return 0; }, End::Refused, n);
            ++failed;
        }
        CHECK(folder.failed() > failed / 2);
        at = 0;
        folder.requireNextIsWhole();
    }
}

TEST_CASE("any write may fail, in every format") {
    const auto grid = shape();
    for (const MeshFormat& format : meshFormats()) {
        for (const int compression : format.compresses ? std::vector<int>{0, 1} : std::vector<int>{0}) {
            CAPTURE(format.name, compression);
            const std::string name = nameFor(format);
            Folder folder([&](const TempFolder& temp) {
                meshInto(*grid, Options(), temp.file(name), format.name, compression);
            });
            folder.checkWrites();
            if (folder.whole().size() == 1) folder.checkRename();
        }
    }
    Folder surface([&](const TempFolder& temp) {
        SurfaceFile file(temp.file("surface.ply"));
        volumeToTets(*grid, file);
    });
    surface.checkWrites();
    surface.checkRename();
}

TEST_CASE("any chunk may be refused, in every format") {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 20.3));
    for (const MeshFormat& format : meshFormats()) {
        CAPTURE(format.name);
        const std::string name = nameFor(format);
        std::int64_t at = 0;
        Folder folder([&](const TempFolder& temp) {
            meshInto(*grid, Options(), temp.file(name), format.name, 0, nullptr, at);
        });
        for (at = 1; at < 4; ++at) folder.check([](std::int64_t) { return 0; }, End::Refused, at);
        CHECK(folder.failed() > 0);
        at = 0;
        folder.requireNextIsWhole();
    }
}
