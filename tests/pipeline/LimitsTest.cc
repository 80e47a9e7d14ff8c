// What would be too much is refused before the work, with the figures.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <string>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;
using openvdb::FloatGrid;

namespace {

FloatGrid::Ptr ball() { return levelSet(sphere({0.3, -0.2, 0.1}, 20.2)); }

/// Constant tiles of 4096 voxels an edge, so many along each axis.
FloatGrid::Ptr bomb(int tiles) {
    const auto grid = FloatGrid::create(3.0f);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::CoordBBox box(Coord(0), Coord(tiles - 1));
    for (auto at = box.begin(); at; ++at)
        grid->tree().addTile(3, Coord(4096 * (*at).x(), 4096 * (*at).y(), 4096 * (*at).z()), -3.0f, true);
    return grid;
}

/// Takes nothing, and remembers which stages there were.
struct Watcher final : MeshSink, openvdb::util::NullInterrupter {
    bool begin(const MeshTotals&) override { return false; }
    void chunk(const MeshChunk&) override {}
    void end() override {}
    void start(const char* name = nullptr) override { stages.emplace_back(name); }

    std::vector<std::string> stages;
};

struct Refused {
    std::string message, stage;
};

Refused refusal(const FloatGrid& grid, const Options& options) {
    Watcher watcher;
    try {
        volumeToTets(grid, watcher, options, &watcher);
    } catch (const TooLarge& error) {
        return {error.what(), watcher.stages.back()};
    }
    return {};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("meshes of more tets than the limit are refused with both numbers, and others are not") {
    for (const bool grade : {false, true}) {
        Options options;
        options.grade = grade;
        const std::int64_t tets = meshOf(*ball(), options).report.tets;
        options.maxTets = tets;
        CHECK(meshOf(*ball(), options).report.tets == tets);
        --options.maxTets;
        const Refused refused = refusal(*ball(), options);
        CHECK(contains(refused.message, std::to_string(tets) + " tets"));
        CHECK(contains(refused.message, "limit of " + std::to_string(tets - 1)));
        CHECK(contains(refused.message, "grade") != grade);
        CHECK(refused.stage == "numbering");
    }
}

TEST_CASE("an inside of too many tets is refused before the surface is looked at") {
    const auto grid = constantTiles(128, {{0, 0, 0}, {128, 0, 0}}, false);
    Options options;
    options.maxTets = 30000000;
    const Refused refused = refusal(*grid, options);
    CHECK(contains(refused.message, "at least "));
    CHECK(refused.stage == "layout");
    options.grade = true;
    CHECK(refusal(*grid, options).message.empty());
}

TEST_CASE("a mesh that has too many tets at the surface alone is refused once so many have been seen") {
    Options options;
    options.maxTets = 1000;
    const Refused refused = refusal(*ball(), options);
    CHECK(contains(refused.message, "more tets than the limit of 1000;"));
    CHECK(refused.stage == "cuts");
    options.grade = true; // whose inside tets may be larger ones, and fewer
    CHECK(refusal(*ball(), options).stage == "numbering");
}

TEST_CASE("what would take more memory than the limit is refused before the work, with both figures") {
    const Report report = meshOf(*ball()).report;
    CHECK(report.gridMemory == std::int64_t(ball()->memUsage()));
    CHECK(report.memory > report.gridMemory);
    Options options;
    options.maxMemory = report.memory;
    CHECK(meshOf(*ball(), options).report.tets == report.tets);
    --*options.maxMemory;
    const Refused refused = refusal(*ball(), options);
    CHECK(contains(refused.message, "GB of memory, more than the limit of 0."));
    CHECK(refused.stage == "tiles");
}

TEST_CASE("limits that are none are refused") {
    for (const std::int64_t limit : {std::int64_t(0), std::int64_t(-1)}) {
        Options tets, memory;
        tets.maxTets = limit;
        memory.maxMemory = limit;
        CHECK_THROWS_AS(meshOf(*ball(), tets), BadOption);
        CHECK_THROWS_AS(meshOf(*ball(), memory), BadOption);
    }
}

TEST_CASE("bombs made of constant tiles are refused by the defaults") {
    const Refused far = refusal(*bomb(4), {});
    CHECK(contains(far.message, "lattice tiles"));
    CHECK(far.stage == "tiles");
}

TEST_CASE("bombs whose surface is small enough are refused for their inside by the defaults", "[slow]") {
    const Refused near = refusal(*bomb(1), {});
    CHECK(contains(near.message, "more tets than"));
    CHECK(near.stage == "cuts");
}
