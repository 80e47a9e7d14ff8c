/// A grid as a field: where the surface is looked for, the two samplers, and the root finder.
#include "support/Catch.h"
#include "support/Fixtures.h"

#include "field/GridField.h"

#include <cmath>
#include <set>

namespace vdbtet::test {

using openvdb::Coord;

namespace {

/// @return whether the field has one sign on a tile and on all lattice neighbours of its vertices.
bool isUniform(Field::Sampler& sampler, const Coord& tile) {
    std::vector<TileSigns> signs;
    for (int slot = 0; slot < 27; ++slot) {
        signs.push_back(sampler.signs(tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1)));
    }
    const bool sign = signs[13][bcc::A].test(0);
    for (int lattice = 0; lattice < 2; ++lattice) {
        MasksAround around;
        for (int slot = 0; slot < 27; ++slot) around.masks[slot] = &signs[slot][lattice];
        for (int slot = 0; slot < 27; ++slot) {
            const TileMask shifted = around.shifted(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
            if (shifted != TileMask::filled(sign)) return false;
        }
    }
    return true;
}

/// Every tile of the box that is not named must be uniform.
void requireCovered(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& voxels, double voxelsPerCell) {
    const Frame frame = makeFrame(grid.transform(), voxelsPerCell * shortestVoxelEdge(grid.transform()));
    const GridField<openvdb::FloatGrid> field(grid, frame, Level{0.0, true});
    Interrupt interrupt(nullptr);
    const auto tiles = field.surfaceTiles(1 << 20, interrupt);
    REQUIRE(!tiles.empty());
    const std::set<Coord> named(tiles.begin(), tiles.end());
    const auto sampler = field.sampler();
    openvdb::CoordBBox box;
    for (int corner = 0; corner < 8; ++corner) {
        const openvdb::Vec3d at =
            frame.fromIndex * openvdb::Vec3d(corner & 1 ? voxels.min().x() : voxels.max().x(),
                                             corner & 2 ? voxels.min().y() : voxels.max().y(),
                                             corner & 4 ? voxels.min().z() : voxels.max().z());
        box.expand(
            Coord(int(std::floor(at.x() / 8)), int(std::floor(at.y() / 8)), int(std::floor(at.z() / 8))));
    }
    box.expand(1);
    for (auto it = box.begin(); it; ++it) {
        if (named.count(*it) == 0 && !isUniform(*sampler, *it)) FAIL("tile " << *it << " was overlooked");
    }
}

} // namespace

TEST_CASE("no tile near the surface is overlooked", "[field]") {
    const double cell = GENERATE(1.0, 0.37, 2.3, 9.0);
    CAPTURE(cell);
    SECTION("of a ball") {
        const auto grid = levelSet(sphere(Vec3d(0.3, -0.2, 0.1), 9.4));
        requireCovered(*grid, openvdb::CoordBBox(Coord(-14), Coord(14)), cell);
    }
    SECTION("under a rotation") {
        const auto transform = rotatedTransform(0.7);
        const auto grid = levelSet(sphere(Vec3d(0.3, -0.2, 0.1), 5.0), transform);
        requireCovered(*grid, openvdb::CoordBBox(Coord(-12), Coord(12)), cell);
    }
    SECTION("of constant tiles without leaves") {
        const auto grid = constantTiles(8, {Coord(0, 0, 0), Coord(8, 8, 0), Coord(-8, 0, 8)}, false);
        requireCovered(*grid, openvdb::CoordBBox(Coord(-10), Coord(18)), cell);
    }
    SECTION("of a tile between a leaf and the background") {
        auto grid = constantTiles(8, {Coord(0, 0, 0)}, true);
        grid->tree().setValueOnly(Coord(8, 0, 0), -1.0f);
        grid->tree().setValueOnly(Coord(-8, 0, 0), 1.0f);
        requireCovered(*grid, openvdb::CoordBBox(Coord(-10), Coord(18)), cell);
    }
    SECTION("of random signs") {
        requireCovered(*randomSigns(10, 5), openvdb::CoordBBox(Coord(-2), Coord(12)), cell);
    }
}

TEST_CASE("a large tile's faces are found against small neighbours and the other way round", "[field]") {
    auto grid = constantTiles(128, {Coord(0, 0, 0)}, true);
    grid->tree().addTile(1, Coord(128, 0, 0), -3.0f, true);
    grid->tree().addTile(1, Coord(-8, 64, 64), -3.0f, true);
    requireCovered(*grid, openvdb::CoordBBox(Coord(-12), Coord(140)), 4.0);
}

TEST_CASE("sampling voxels and sampling points agree", "[field]") {
    const auto grid = levelSet(noiseBall(7, Vec3d(0.0), 10.0, 4.0));
    const Frame frame = makeFrame(grid->transform(), 1.0);
    const Level level{0.0, true};
    VoxelSampler<openvdb::FloatGrid> voxels(*grid, level);
    TrilinearSampler<openvdb::FloatGrid> points(*grid, frame, level);
    const openvdb::CoordBBox box(Coord(-2), Coord(1));
    int cuts = 0;
    for (auto it = box.begin(); it; ++it) {
        const TileSigns signs = voxels.signs(*it);
        REQUIRE(signs == points.signs(*it));
        // Any edge between two vertices of the tile will do.
        MasksAround inB;
        const TileMask none;
        inB.masks.fill(&none);
        inB.masks[13] = &signs[bcc::B];
        EdgeMasks cut{};
        const int d = 7; // toward +x +y +z, which stays in the tile
        const bcc::Step step = bcc::shortEdge(bcc::A, d);
        cut[d] = signs[bcc::A] ^ inB.shifted(step.x, step.y, step.z);
        const EdgeMasks near = voxels.nearerToA(*it, cut);
        REQUIRE(near == points.nearerToA(*it, cut));
        std::vector<float> a(near[d].count()), b(a.size());
        voxels.cutPoints(*it, bcc::A, near, a.data());
        points.cutPoints(*it, bcc::A, near, b.data());
        for (size_t i = 0; i < a.size(); ++i) {
            REQUIRE(std::abs(a[i] - b[i]) < 1e-6f);
            REQUIRE(a[i] >= 0.0f);
            REQUIRE(a[i] <= 0.5f);
        }
        EdgeMasks far{};
        far[bcc::opposite(d)] = cut[d] & ~near[d];
        a.resize(far[bcc::opposite(d)].count());
        b.resize(a.size());
        voxels.cutPoints(*it, bcc::B, far, a.data());
        points.cutPoints(*it, bcc::B, far, b.data());
        for (size_t i = 0; i < a.size(); ++i) REQUIRE(std::abs(a[i] - b[i]) < 1e-6f);
        cuts += cut[d].count();
    }
    REQUIRE(cuts > 100);
}

TEST_CASE("the root finder stays in its bracket and meets hard functions", "[field]") {
    const auto root = [](auto f) { return rootInUnitInterval(f(0.0), f(1.0), f); };
    REQUIRE(root([](double x) { return x - 0.25; }) == Approx(0.25));
    REQUIRE(root([](double x) { return 0.25 - x; }) == Approx(0.25));
    REQUIRE(root([](double x) { return x * x * x - 1e-9; }) == Approx(1e-3));
    REQUIRE(root([](double x) { return 1e300 * (x - 0.5); }) == Approx(0.5));
    REQUIRE(root([](double x) { return 1e-300 * (0.3 - x); }) == Approx(0.3));
    REQUIRE(root([](double x) { return x < 0.7 ? -1.0 : 1.0; }) == Approx(0.7));
    REQUIRE(root([](double x) { return x; }) == 0.0);
    REQUIRE(root([](double x) { return x - 1.0; }) == 1.0);
}

TEST_CASE("a cut point in the middle belongs to the first end", "[field]") {
    REQUIRE(cutInFirstHalf(1.0, 0.0, -1.0));
    REQUIRE(cutInFirstHalf(-1.0, 0.0, 1.0));
    REQUIRE(cutInFirstHalf(1.0, 1e-9, -1.0));
    REQUIRE(cutInFirstHalf(1.0, -0.1, -1.2));
    REQUIRE(!cutInFirstHalf(1.0, 0.1, -0.8));
    REQUIRE(distanceToCut(1.0, [](double s) { return 1.0 - 1.999999999 * s; }) == 0.5f);
}

} // namespace vdbtet::test
