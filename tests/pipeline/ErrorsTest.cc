// What cannot be meshed is refused, by an exception that says why.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MemoryLimit.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <functional>
#include <limits>
#include <string>

using namespace vdbtet;
using namespace vdbtet::test;
using openvdb::Coord;
using openvdb::FloatGrid;

namespace {

FloatGrid::Ptr ball() { return levelSet(sphere({0.3, -0.2, 0.1}, 8.2)); }

/// Counts its calls: a refused grid must not reach the sink.
struct UntouchedSink final : MeshSink {
    bool begin(const MeshTotals&) override { return ++calls; }
    void chunk(const MeshChunk&) override { ++calls; }
    void end() override { ++calls; }
    int calls = 0;
};

template <typename Exception>
void requireRefused(const openvdb::GridBase& grid, const Options& options = {}) {
    UntouchedSink sink;
    try {
        volumeToTets(grid, sink, options);
        FAIL("the grid was not refused");
    } catch (const Exception& error) {
        CHECK(std::string(error.what()).size() > 20);
    }
    CHECK(sink.calls == 0);
}

Options with(const std::function<void(Options&)>& change) {
    Options options;
    change(options);
    return options;
}

} // namespace

TEST_CASE("grids of other types are refused") {
    requireRefused<UnsupportedGrid>(*openvdb::Int32Grid::create(1));
    requireRefused<UnsupportedGrid>(*openvdb::BoolGrid::create(true));
    requireRefused<UnsupportedGrid>(*openvdb::Vec3SGrid::create());
    requireRefused<UnsupportedGrid>(*openvdb::MaskGrid::create());
}

TEST_CASE("frustum transforms are refused") {
    const auto grid = ball();
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(-20.0), Vec3d(20.0)), 0.3, 10.0));
    requireRefused<UnsupportedGrid>(*grid);
}

TEST_CASE("grids with the background inside are refused") {
    requireRefused<UnboundedInside>(*negated(*ball()));
    requireRefused<UnboundedInside>(*ball(), with([](Options& o) { o.inside = Inside::Above; }));
    requireRefused<UnboundedInside>(*ball(), with([](Options& o) { o.isovalue = 4; }));
    // The background equals the isovalue: that counts as inside.
    requireRefused<UnboundedInside>(*ball(), with([](Options& o) { o.isovalue = 3; }));
    requireRefused<UnboundedInside>(*FloatGrid::create(-1.0f),
                                    with([](Options& o) { o.inside = Inside::Below; }));
}

TEST_CASE("grids without a surface are refused") {
    requireRefused<NoSurface>(*FloatGrid::create(3.0f));
    requireRefused<NoSurface>(*ball(), with([](Options& o) { o.isovalue = -4; }));
    const auto positive = ball();
    for (auto it = positive->beginValueAll(); it; ++it) it.setValue(std::abs(*it) + 0.1f);
    requireRefused<NoSurface>(*positive);
    const auto fog = fogVolume(sphere(Vec3d(0.0), 5), uniformTransform(1.0));
    requireRefused<NoSurface>(*fog, with([](Options& o) { o.isovalue = 2; }));
    // A ball that falls between the points of a coarse lattice.
    requireRefused<NoSurface>(*levelSet(sphere(Vec3d(12.0, 0, 0), 3)),
                              with([](Options& o) { o.spacing = 24; }));
}

TEST_CASE("values that have no sign are refused wherever they are") {
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity()};
    for (const float value : bad) {
        const auto onSurface = ball(), inBand = ball();
        onSurface->tree().setValue(Coord(8, 0, 0), value);
        requireRefused<BadValue>(*onSurface);
        inBand->tree().setValueOff(Coord(6, 0, 0), value);
        requireRefused<BadValue>(*inBand);
    }
}

TEST_CASE("options out of range are refused") {
    const double bad[] = {0, -1, std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity()};
    for (const double value : bad) {
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.spacing = value; }));
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.voxels = value; }));
    }
    for (const int tiger : {-1, 0, 4})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.tiger = tiger; }));
    for (const double tau : {0.0, 0.49, 0.81, bad[2]})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.tiger = 3, o.tau = tau; }));
    requireRefused<BadOption>(*ball(), with([=](Options& o) { o.tau = 0.7; }));
    for (const double value : {bad[2], bad[3], -bad[3]})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.isovalue = value; }));
    for (const double target : {0.5, 38.5, -30.0, bad[2], bad[3]})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.optimize = target; }));
    for (const int sweeps : {-1, 0, 1001})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.sweeps = sweeps; }));
    for (const std::int64_t limit : {std::int64_t(0), std::int64_t(-1)})
        requireRefused<BadOption>(*ball(), with([=](Options& o) { o.maxSurfaceTiles = limit; }));
}

TEST_CASE("surfaces of too many tiles are refused") {
    requireRefused<TooLarge>(*ball(), with([](Options& o) { o.maxSurfaceTiles = 5; }));
    Meshed whole = meshOf(*ball());
    const std::int64_t tiles = whole.report.surfaceTiles;
    CHECK(meshOf(*ball(), with([](Options& o) { o.maxSurfaceTiles = 4096; })).report.surfaceTiles == tiles);
    // A file of a few hundred bytes: the surface of a cube of 16384 voxels.
    const auto bomb = FloatGrid::create(3.0f);
    bomb->setGridClass(openvdb::GRID_LEVEL_SET);
    for (int x = -8192; x < 8192; x += 4096)
        for (int y = -8192; y < 8192; y += 4096)
            for (int z = -8192; z < 8192; z += 4096) bomb->tree().addTile(3, Coord(x, y, z), -3.0f, true);
    requireRefused<TooLarge>(*bomb);
}

TEST_CASE("a lattice too fine for its surface is refused before it takes memory") {
    for (const double voxels : {1e-2, 1e-3, 1e-4, 1e-9}) {
        CAPTURE(voxels);
        const MemoryLimit limit(std::uint64_t(1) << 30);
        requireRefused<TooLarge>(*ball(), with([&](Options& o) {
            o.voxels = voxels;
            o.maxSurfaceTiles = 100000;
        }));
    }
}

TEST_CASE("lattices beyond the precision of coordinates are refused") {
    const auto grid = ball();
    grid->setTransform(uniformTransform(1.0, Vec3d(1e15)));
    requireRefused<TooLarge>(*grid);
}
