/// The threshold and the destinations of version 3.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/ThirdStages.h"

#include <openvdb/tools/Interpolation.h>

#include <cmath>

namespace vdbtet::test {

namespace {

/// The tile at the origin in the middle of voxels whose values are linear, negative inside.
openvdb::DoubleGrid::Ptr linear(const Vec3d& normal, double offset) {
    auto grid = openvdb::DoubleGrid::create(100.0);
    const openvdb::CoordBBox box(openvdb::Coord(-16), openvdb::Coord(23));
    for (auto it = box.begin(); it; ++it) grid->tree().setValue(*it, normal.dot((*it).asVec3d()) - offset);
    return grid;
}

/// Whether the vertices of the tile that are near enough to a plane are told the way to it.
void requireOnPlane(Field::Sampler& sampler, const Vec3d& normal, double offset, double spacing) {
    int met = 0, missed = 0;
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        std::vector<std::uint16_t> vertices;
        std::vector<double> reach, height;
        for (int n = 0; n < TileMask::kSize; ++n) {
            const Vec3d home = homeOf(localIndex(lattice, n));
            vertices.push_back(std::uint16_t(PaddedMask::bit(n)));
            height.push_back((normal.dot(home * spacing) - offset) / (normal.length() * spacing));
            reach.push_back(0.6);
        }
        std::vector<Vec3d> offsets(vertices.size());
        sampler.alongGradient(openvdb::Coord(0), lattice, vertices, reach, offsets.data());
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            if (std::abs(std::abs(height[i]) - 0.6) < 1e-9) continue;
            const bool isNear = std::abs(height[i]) < 0.6;
            const Vec3d expected = isNear ? normal.unit() * -height[i] : Vec3d(0.0);
            REQUIRE((offsets[i] - expected).length() < 1e-12);
            ++(isNear ? met : missed);
        }
    }
    CHECK(met > 100);
    CHECK(missed > 100);
}

} // namespace

TEST_CASE("where the field is linear vertices move along the normal", "[destinations]") {
    Random random(5);
    for (int i = 0; i < 8; ++i) {
        const Vec3d normal = random.inBox(-1.0, 1.0);
        const double offset = normal.dot(Vec3d(3.6, 3.7, 3.8));
        const auto grid = linear(normal, offset);
        const Level level{0.0, true};
        VoxelSampler<openvdb::DoubleGrid> voxels(*grid, level);
        requireOnPlane(voxels, normal, offset, 1.0);
        for (const double spacing : {1.0, 1.3}) {
            TrilinearSampler<openvdb::DoubleGrid> points(*grid, makeFrame(grid->transform(), spacing), level);
            requireOnPlane(points, normal, normal.dot(Vec3d(3.6, 3.7, 3.8)), spacing);
        }
    }
}

TEST_CASE("where nothing slopes, or the surface is too far, no way leads to it", "[destinations]") {
    const double flat[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    CHECK(rootAlongGradient(1.0, flat, 0.5, [](const Vec3d&) { return -1.0; }) == Vec3d(0.0));
    const double sloped[8] = {0, 0, 0, 0, 2, 2, 2, 2};
    CHECK(gradientEstimate(sloped) == Vec3d(2, 0, 0));
    const auto phi = [](const Vec3d& offset) { return 1.0 + 2.0 * offset.x(); };
    CHECK(rootAlongGradient(1.0, sloped, 0.49, phi) == Vec3d(0.0));
    CHECK((rootAlongGradient(1.0, sloped, 0.6, phi) - Vec3d(-0.5, 0, 0)).length() < 1e-12);
    CHECK((rootAlongGradient(-1.0, sloped, 0.6, [](const Vec3d& o) { return 2.0 * o.x() - 1.0; }) -
           Vec3d(0.5, 0, 0))
              .length() < 1e-12);
}

TEST_CASE("an arrow leaves the inside end of an edge up to the threshold", "[labels]") {
    for (const double tau : {0.5, 0.6, 0.77}) {
        const auto grid = levelSet(noiseBall(1, Vec3d(0.1, 0.2, 0.3), 11.0, 3.0));
        const ThirdStages stages(*grid, 1.0, tau);
        const auto probe = stages.field.probe();
        int arrows[2] = {0, 0};
        for (const TileRef t : stages.cuts.arrows.tiles) {
            const auto& tile = stages.layout.surfaceTiles[t];
            for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
                for (int d = 0; d < bcc::kDirections; ++d) {
                    (*stages.cuts.arrows.of[t])[lattice][d].forEach([&](int n) {
                        const Vec3d from = homeOf(localIndex(lattice, n)) +
                                           Vec3d(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z());
                        const bool isInside = stages.cuts.signs[t][lattice].test(n);
                        const double reach = isInside ? tau : 1.0 - tau;
                        const double there =
                            probe->at(from + reach * Vec3d(bcc::kShortEdges[d])).phi * (isInside ? 1 : -1);
                        REQUIRE(there <= 1e-6);
                        ++arrows[isInside];
                    });
                }
            }
        }
        CHECK(arrows[0] + arrows[1] == stages.cuts.arrows.cutEdges);
        if (tau > 0.7) CHECK(arrows[1] > arrows[0]);
    }
}

TEST_CASE("no vertex moves farther than its edge would have taken it, and all come to the surface",
          "[destinations]") {
    const auto grid = levelSet(noiseBall(4, Vec3d(0.1, 0.2, 0.3), 11.0, 2.0));
    ThirdStages stages(*grid);
    stages.guard();
    const auto probe = stages.field.probe();
    std::int64_t offEdges = 0, flagged = 0;
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        const auto& tile = stages.layout.surfaceTiles[t];
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            std::int64_t move = stages.destinations.first[t][lattice];
            stages.labels.manifold[t][lattice].forEach([&](int n) {
                const Vec3d offset = stages.destinations.move(move++);
                const bool isFlagged = stages.flagged[t][lattice].test(n);
                const bool isInside = stages.cuts.signs[t][lattice].test(n);
                const double farthest = isFlagged ? 0.5 : isInside ? 0.7 : 0.5;
                REQUIRE(offset.length() <= farthest * std::sqrt(0.75) + 1e-6);
                const bool onEdge = std::abs(std::abs(offset.x()) - std::abs(offset.y())) < 1e-6 &&
                                    std::abs(std::abs(offset.x()) - std::abs(offset.z())) < 1e-6;
                if (isFlagged) REQUIRE(onEdge);
                offEdges += !onEdge;
                flagged += isFlagged;
                const Vec3d place = homeOf(localIndex(lattice, n)) +
                                    Vec3d(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z()) + offset;
                REQUIRE(std::abs(probe->at(place).phi) < 1e-5);
            });
        }
    }
    CHECK(offEdges > 1000);
    CHECK(flagged > 10);
}

} // namespace vdbtet::test
