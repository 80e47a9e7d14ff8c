// What the host of an interrupter learns of how far a run is.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <tbb/task_arena.h>

#include <map>
#include <mutex>
#include <string>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Notes what it is told.
class Listener final : public openvdb::util::NullInterrupter {
public:
    void start(const char* name = nullptr) override {
        CHECK_FALSE(working);
        working = true;
        stages.push_back(name);
    }
    void end() override {
        CHECK(working);
        working = false;
    }
    bool wasInterrupted(int percent = -1) override {
        const std::lock_guard<std::mutex> lock(mMutex);
        percents[stages.back()].push_back(percent);
        return false;
    }

    bool working = false;
    std::vector<std::string> stages;
    std::map<std::string, std::vector<int>> percents;

private:
    std::mutex mMutex;
};

/// Mesh on one thread, where no question overtakes another.
Report mesh(const openvdb::FloatGrid& grid, const Options& options, Listener& listener, bool chunks = true) {
    struct Dropping final : MeshSink {
        bool begin(const MeshTotals&) override { return wanted; }
        void chunk(const MeshChunk&) override {}
        void end() override {}
        bool wanted = true;
    };
    Report report;
    tbb::task_arena(1).execute([&] {
        Dropping sink;
        sink.wanted = chunks;
        report = volumeToTets(grid, sink, options, &listener);
    });
    return report;
}

} // namespace

TEST_CASE("an interrupter is told each stage of the report, one after the other") {
    const auto grid = levelSet(noiseBall(2, {0.3, -0.2, 0.1}, 16, 3));
    Options options;
    options.optimize = 30;
    options.grade = GENERATE(false, true);
    Listener listener;
    const Report report = mesh(*grid, options, listener);
    CHECK_FALSE(listener.working);
    std::vector<std::string> stages;
    for (const auto& stage : report.stages) stages.push_back(stage.name);
    CHECK(listener.stages == stages);
}

TEST_CASE("percents of a stage rise from the first to the last part of its work") {
    const auto grid = levelSet(torus({0.3, -0.2, 0.1}, 90, 40));
    Options options;
    options.optimize = 30;
    const bool chunks = GENERATE(true, false);
    Listener listener;
    mesh(*grid, options, listener, chunks);
    // Repair has nothing to do here.
    for (const char* stage : {"tiles", "cuts", "layout", "labels", "destinations", "flips", "optimize",
                              "numbering", chunks ? "emit" : "measure"}) {
        CAPTURE(stage);
        int last = 0, first = -1;
        for (const int percent : listener.percents.at(stage)) {
            CHECK(percent <= 100);
            if (percent < 0) continue; // no one knows
            if (first < 0) first = percent;
            CHECK(percent >= last);
            last = percent;
        }
        CHECK(first >= 0);
        CHECK(first <= 10);
        CHECK(last >= 80);
    }
}

TEST_CASE("a stage that throws has ended for its interrupter") {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 9));
    Options options;
    options.maxSurfaceTiles = 1;
    Listener listener;
    CHECK_THROWS_AS(mesh(*grid, options, listener), TooLarge);
    CHECK_FALSE(listener.working);
    CHECK(listener.stages == std::vector<std::string>{"scan", "tiles"});
}
