// A run can be stopped at any time, and then leaves no whole mesh behind.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <atomic>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Says stop from the n-th time on that it is asked.
class StopAt final : public openvdb::util::NullInterrupter {
public:
    explicit StopAt(std::int64_t n) : mLimit(n) {}
    void start(const char* = nullptr) override { ++mStarts; }
    void end() override { ++mEnds; }
    bool wasInterrupted(int = -1) override { return ++mAsked >= mLimit; }

    std::int64_t asked() const { return mAsked; }
    int starts() const { return mStarts; }
    int ends() const { return mEnds; }

private:
    const std::int64_t mLimit;
    std::atomic<std::int64_t> mAsked{0};
    int mStarts = 0, mEnds = 0;
};

/// Notes which of its calls came.
struct WatchedSink final : MeshSink {
    bool begin(const MeshTotals& totals) override {
        begun = true;
        return mesh.begin(totals);
    }
    void chunk(const MeshChunk& chunk) override { mesh.chunk(chunk); }
    void end() override { ended = true; }

    TetMesh mesh;
    bool begun = false, ended = false;
};

} // namespace

TEST_CASE("a run stops wherever its interrupter says so") {
    const auto grid = levelSet(torus({0.3, -0.2, 0.1}, 25, 11));
    const Meshed whole = meshOf(*grid);

    StopAt never(std::int64_t(1) << 60);
    WatchedSink undisturbed;
    const Report report = volumeToTets(*grid, undisturbed, {}, &never);
    CHECK_FALSE(report.cancelled);
    CHECK(undisturbed.ended);
    requireIdentical(undisturbed.mesh, whole.mesh);
    CHECK(never.starts() == int(report.stages.size()));
    CHECK(never.ends() == never.starts());
    // Once a range in every stage of a torus of some 200 tiles.
    CHECK(never.asked() > 20);

    bool stoppedBeforeBegin = false, stoppedAfterBegin = false;
    for (std::int64_t n = 1; n <= never.asked(); n += 1 + n / 32) {
        StopAt interrupter(n);
        WatchedSink sink;
        const Report stopped = volumeToTets(*grid, sink, {}, &interrupter);
        CAPTURE(n, sink.begun);
        CHECK(interrupter.starts() == interrupter.ends());
        // The number of questions may depend on how the threads share the work, the answer may not.
        if (stopped.cancelled) {
            CHECK_FALSE(sink.ended);
            (sink.begun ? stoppedAfterBegin : stoppedBeforeBegin) = true;
        } else {
            CHECK(interrupter.asked() <= n); // the last question comes too late
            CHECK(sink.ended);
            requireIdentical(sink.mesh, whole.mesh);
        }
    }
    CHECK(stoppedBeforeBegin);
    CHECK(stoppedAfterBegin);
}

TEST_CASE("optimisation stops when its interrupter says so") {
    const auto grid = levelSet(noiseBall(2, {0.3, -0.2, 0.1}, 16, 3));
    Options options;
    options.optimize = 35;
    const Meshed whole = meshOf(*grid, options);
    StopAt never(std::int64_t(1) << 60);
    TetMesh undisturbed;
    volumeToTets(*grid, undisturbed, options, &never);
    requireIdentical(undisturbed, whole.mesh);
    bool stoppedInStage = false;
    for (std::int64_t n = 1; n <= never.asked(); n += 1 + n / 16) {
        StopAt interrupter(n);
        WatchedSink sink;
        const Report stopped = volumeToTets(*grid, sink, options, &interrupter);
        if (stopped.cancelled) {
            CHECK_FALSE(sink.ended);
            stoppedInStage = stoppedInStage || stopped.stages.back().name == "optimize";
        } else {
            requireIdentical(sink.mesh, whole.mesh);
        }
    }
    CHECK(stoppedInStage);
}

TEST_CASE("a run that is to stop at once does no work") {
    const auto grid = levelSet(sphere({0.3, -0.2, 0.1}, 9));
    StopAt interrupter(1);
    WatchedSink sink;
    CHECK(volumeToTets(*grid, sink, {}, &interrupter).cancelled);
    CHECK_FALSE(sink.begun);
    CHECK(sink.mesh.tets.empty());
}

TEST_CASE("an interrupter that never stops changes nothing") {
    const auto grid = levelSet(noiseBall(2, {0.3, -0.2, 0.1}, 12, 3));
    openvdb::util::NullInterrupter interrupter;
    TetMesh mesh;
    const Report report = volumeToTets(*grid, mesh, {}, &interrupter);
    const Meshed plain = meshOf(*grid);
    CHECK_FALSE(report.cancelled);
    CHECK(report.tets == plain.report.tets);
    requireIdentical(mesh, plain.mesh);
}
