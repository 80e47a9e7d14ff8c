/// A grid as a field: where the surface is looked for, the two samplers, and the root finder.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include "destinations/LocalVertices.h"
#include "field/GridField.h"

#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace vdbtet::test {

using openvdb::Coord;

namespace {

/// @return whether the field has one sign on the octahedra that a tile owns and on all ends of their edges:
/// the vertices of L_A at -1 to 9 and of L_B at -1 to 8.
bool isUniform(Field::Sampler& sampler, const Coord& tile) {
    std::vector<TileSigns> signs;
    for (int slot = 0; slot < 27; ++slot)
        signs.push_back(signsOf(sampler, tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1)));
    const bool sign = signs[13][bcc::A].test(0);
    for (int lattice = 0; lattice < 2; ++lattice) {
        const int last = lattice == bcc::A ? 9 : 8;
        for (int x = -1; x <= last; ++x) {
            for (int y = -1; y <= last; ++y) {
                for (int z = -1; z <= last; ++z) {
                    const int slot = neighbourSlot(tileStep(x), tileStep(y), tileStep(z));
                    if (signs[slot][lattice].test(TileMask::bit(x & 7, y & 7, z & 7)) != sign) return false;
                }
            }
        }
    }
    return true;
}

/// Every tile of the box that is not named must be uniform.
void requireCovered(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& voxels, double voxelsPerCell) {
    const Frame frame = makeFrame(grid.transform(), voxelsPerCell * shortestVoxelEdge(grid.transform()));
    const GridField<openvdb::FloatGrid> field(grid, frame, Level{0.0, true});
    Interrupt interrupt(nullptr);
    const auto tiles = field.surfaceTiles(1 << 20, 0, interrupt);
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
    const double tau = GENERATE(0.5, 0.7);
    size_t cuts = 0;
    for (auto it = box.begin(); it; ++it) {
        PaddedMask a, b, a2, b2;
        voxels.signs(*it, a, b);
        points.signs(*it, a2, b2);
        REQUIRE((a.core() == a2.core() && b.core() == b2.core()));
        PaddedEdgeMasks cut, halved, nearer, nearer2;
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(bcc::A, d);
            for (int n = 0; n < TileMask::kSize; ++n) {
                const int vertex = PaddedMask::bit(n);
                if (a.test(vertex) != b.test(vertex + PaddedMask::step(step.x, step.y, step.z)))
                    (n % 3 == 0 ? halved : cut)[d].set(vertex);
            }
        }
        for (Field::Sampler* sampler :
             {static_cast<Field::Sampler*>(&voxels), static_cast<Field::Sampler*>(&points)}) {
            PaddedEdgeMasks& found = sampler == &voxels ? nearer : nearer2;
            sampler->nearerToA(*it, cut, tau, found);
            sampler->nearerToA(*it, halved, 0.5, found);
        }
        std::vector<ShortEdge> edges[2]; // by the lattice of the nearer end
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(bcc::A, d);
            const int toB = PaddedMask::step(step.x, step.y, step.z);
            for (const auto* some : {&cut, &halved}) {
                (*some)[d].forEach([&](int n) {
                    const bool isNearer = nearer[d].test(n);
                    REQUIRE(isNearer == nearer2[d].test(n));
                    edges[isNearer ? bcc::A : bcc::B].push_back(
                        {std::uint16_t(isNearer ? n : n + toB), std::uint8_t(isNearer ? d : bcc::opposite(d)),
                         some == &halved});
                    ++cuts;
                });
            }
        }
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            // A sampler is asked for edges from the tile's own vertices.
            auto& own = edges[lattice];
            own.erase(std::remove_if(own.begin(), own.end(),
                                     [](const ShortEdge& e) {
                                         return std::min({PaddedMask::x(e.vertex), PaddedMask::y(e.vertex),
                                                          PaddedMask::z(e.vertex)}) < 0;
                                     }),
                      own.end());
            std::vector<float> one(own.size()), two(own.size());
            voxels.cutPoints(*it, lattice, own, tau, one.data());
            points.cutPoints(*it, lattice, own, tau, two.data());
            for (size_t i = 0; i < one.size(); ++i) {
                REQUIRE(std::abs(one[i] - two[i]) < 1e-6f);
                REQUIRE(one[i] >= 0.0f);
                const bool isInside = (lattice == bcc::A ? a : b).test(own[i].vertex);
                REQUIRE(one[i] <= float(own[i].halved ? 0.5 : isInside ? tau : 1.0 - tau));
            }
        }
    }
    REQUIRE(cuts > 1000);
}

TEST_CASE("points are sampled as OpenVDB samples them, whether few voxels lie around a tile or many",
          "[field]") {
    const double cell = GENERATE(0.37, 2.3, 9.0);
    CAPTURE(cell);
    const auto grid = levelSet(noiseBall(5, Vec3d(0.0), 11.0, 3.0), rotatedTransform(0.7));
    const Frame frame = makeFrame(grid->transform(), cell * shortestVoxelEdge(grid->transform()));
    TrilinearSampler<openvdb::FloatGrid> sampler(*grid, frame, Level{0.0, true});
    int inside = 0, outside = 0;
    const openvdb::CoordBBox box(Coord(-3), Coord(2));
    for (auto tile = box.begin(); tile; ++tile) {
        PaddedMask masks[2];
        sampler.signs(*tile, masks[bcc::A], masks[bcc::B]);
        for (int lattice = 0; lattice < 2; ++lattice) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                const Vec3d local = homeOf(localIndex(lattice, n));
                const Vec3d at = frame.toIndex * (8.0 * (*tile).asVec3d() + local);
                const float value = openvdb::tools::BoxSampler::sample(grid->tree(), at);
                if (std::abs(value) < 1e-4f) continue;
                REQUIRE(masks[lattice].test(PaddedMask::bit(n)) == (value < 0.0f));
                ++(value < 0.0f ? inside : outside);
            }
        }
    }
    REQUIRE(inside > 10);
    REQUIRE(outside > 1000);
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
    REQUIRE(cutInFirstPart(1.0, 0.0, -1.0));
    REQUIRE(cutInFirstPart(-1.0, 0.0, 1.0));
    REQUIRE(cutInFirstPart(1.0, 1e-9, -1.0));
    REQUIRE(cutInFirstPart(1.0, -0.1, -1.2));
    REQUIRE(!cutInFirstPart(1.0, 0.1, -0.8));
    REQUIRE(distanceToCut(1.0, 0.5, [](double s) { return 1.0 - 1.999999999 * s; }) == 0.5f);
}

} // namespace vdbtet::test
