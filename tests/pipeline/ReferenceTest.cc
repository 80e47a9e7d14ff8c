// The fast mesher gives the reference mesher's mesh, tet for tet.
#include "reference/GridField.h"
#include "reference/ReferenceMesher.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <algorithm>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Cut points are found to far better than this part of the spacing.
constexpr double kPrecision = 1e-7;

enum class Ties {
    None,   ///< the method itself leaves no choice
    Broken, ///< cycles, and ties of destinations and slices, which rules break that both meshers know
};

ReferenceMesh requireReference(const openvdb::GridBase& grid, const Options& options,
                               Ties ties = Ties::None) {
    const Meshed fast = meshOf(grid, raw(options)); // the method alone
    const GridField field(grid, fast.report.isovalue, fast.report.inside, fast.report.spacing);
    const Labelling labelling = ties == Ties::None ? Labelling::Search : Labelling::Kernel;
    const ReferenceMesh slow = referenceMesh(field.phi(), field.box(), options.tiger, labelling);
    INFO("spacing " << fast.report.spacing << ", version " << options.tiger);

    // A fixture with more than one right answer proves nothing.
    REQUIRE(slow.manyRoots == 0);
    REQUIRE(slow.nearHalfTies == 0);
    if (ties == Ties::None) {
        REQUIRE(slow.halfTies == 0);
        REQUIRE(slow.undecided == 0);
        REQUIRE(slow.destinationTies == 0);
        REQUIRE(slow.sliceTies == 0);
    }
    REQUIRE(!slow.tets.empty());

    TetMesh expected;
    for (const Vec3d& p : slow.points) expected.points.push_back(field.frame().toWorld(p));
    expected.tets = slow.tets;
    requireSame(fast.mesh, expected, kPrecision * fast.report.spacing);

    CHECK(fast.report.ambiguous == slow.ambiguous);
    CHECK(fast.report.conflicts == slow.conflicts);
    CHECK(fast.report.activeFlips == slow.activeFlips);
    CHECK(fast.report.extraFlips == slow.extraFlips);
    CHECK(fast.report.lastResortFlips == slow.lastResortFlips);
    CHECK(fast.report.cutEdges == slow.cutEdges);
    CHECK(fast.report.tieBroken == slow.undecided);
    requireClean(fast.mesh, fast.report);
    return slow;
}

/// The same for version 3.
ReferenceMesh requireThirdReference(const openvdb::GridBase& grid, double voxels, double tau = kDefaultTau) {
    Options options = raw(atVoxels(voxels, 3));
    options.tau = tau;
    const Meshed fast = meshOf(grid, options);
    const GridField field(grid, fast.report.isovalue, fast.report.inside, fast.report.spacing);
    const ReferenceMesh slow = thirdReferenceMesh(field.phi(), field.box(), tau);
    INFO("spacing " << fast.report.spacing << ", tau " << tau);
    REQUIRE(slow.manyRoots == 0);
    REQUIRE(slow.nearHalfTies == 0);
    REQUIRE(!slow.tets.empty());

    TetMesh expected;
    for (const Vec3d& p : slow.points) expected.points.push_back(field.frame().toWorld(p));
    expected.tets = slow.tets;
    requireSame(fast.mesh, expected, kPrecision * fast.report.spacing);
    CHECK(fast.report.ambiguous == slow.ambiguous);
    CHECK(fast.report.activeFlips == slow.activeFlips);
    CHECK(fast.report.qualityFlips == slow.qualityFlips);
    CHECK(fast.report.flagged == slow.flagged);
    CHECK(fast.report.guardRounds == slow.guardRounds);
    CHECK(fast.report.cutEdges == slow.cutEdges);
    CHECK(fast.report.tieBroken == slow.undecided);
    requireClean(fast.mesh, fast.report);
    return slow;
}

/// A point near the origin at which no lattice plane is a plane of symmetry.
Vec3d offCentre(std::uint64_t seed) { return Random(seed).inBox(-0.5, 0.5); }

} // namespace

TEST_CASE("the mesh is the reference's: spheres", "[reference]") {
    for (const double voxels : {1.0, 0.7, 2.0, 3.3})
        for (std::uint64_t seed = 1; seed <= 4; ++seed)
            requireReference(*levelSet(sphere(offCentre(seed), 3.0 * voxels + 0.37 * double(seed))),
                             atVoxels(voxels, 1 + int(seed % 2)));
}

TEST_CASE("the mesh is the reference's: tori", "[reference]") {
    for (const double voxels : {1.0, 0.7, 2.0, 3.3})
        requireReference(*levelSet(torus(offCentre(11), 5 * voxels, 2.2 * voxels)), atVoxels(voxels));
}

TEST_CASE("the mesh is the reference's: gyroids", "[reference]") {
    for (const double voxels : {1.0, 0.7, 2.0})
        requireReference(*levelSet(gyroidBall(offCentre(22), 9 * voxels, 9 * voxels, 3 * voxels)),
                         atVoxels(voxels));
    requireReference(*levelSet(gyroidBall(offCentre(22), 9, 9, 2.2)), atVoxels(1.0));
}

TEST_CASE("the mesh is the reference's: noise", "[reference]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        requireReference(*levelSet(noiseBall(seed, offCentre(seed), 11, 4)),
                         atVoxels(1.0, 1 + int(seed % 2)));
}

TEST_CASE("the mesh is the reference's: noise on finer and coarser lattices", "[reference]") {
    struct Case {
        double voxels, feature;
        std::vector<std::uint64_t> seeds; // such that no edge has more than one root in its nearer half
    };
    const Case cases[] = {{0.6, 1.0, {2, 4, 7, 8}}, {0.6, 1.5, {1, 2, 3, 6}}, {1.7, 1.0, {4, 6, 12}},
                          {1.7, 1.5, {2, 3, 6, 7}}, {2.9, 1.0, {4, 9, 12}},   {2.9, 1.5, {3, 4, 5, 7}}};
    for (const Case& c : cases)
        for (const std::uint64_t seed : c.seeds) {
            const double feature = c.feature * (1 + c.voxels);
            requireReference(*levelSet(noiseBall(seed, offCentre(seed), 6 + 3 * c.voxels, feature)),
                             atVoxels(c.voxels), Ties::Broken);
        }
}

TEST_CASE("the mesh is the reference's: random cuts with every kind of flip", "[reference]") {
    ReferenceMesh sum;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const double insideShare = seed % 2 ? 0.5 : 0.7;
        const ReferenceMesh mesh =
            requireReference(*randomCuts(12, seed, insideShare), atVoxels(2.0), Ties::Broken);
        sum.ambiguous += mesh.ambiguous;
        sum.conflicts += mesh.conflicts;
        sum.activeFlips += mesh.activeFlips;
        sum.extraFlips += mesh.extraFlips;
        sum.lastResortFlips += mesh.lastResortFlips;
        sum.undecided += mesh.undecided;
    }
    requireReference(*randomCuts(12, 1, 0.7), atVoxels(2.0, 1), Ties::Broken);
    // Else the fixtures would not test what they are for.
    CHECK(sum.ambiguous > 0);
    CHECK(sum.conflicts > sum.lastResortFlips);
    CHECK(sum.activeFlips > 0);
    CHECK(sum.extraFlips > 0);
    CHECK(sum.lastResortFlips > 0);
    CHECK(sum.undecided > 0);
}

TEST_CASE("the mesh is the reference's: symmetric shapes whose ties the rules break", "[reference]") {
    // On a turned lattice that is not the voxels' rounding makes the ties inexact.
    for (const bool turnedLattice : {false, true}) {
        const double voxels = turnedLattice ? 0.5 : 1.0;
        const auto meshed = [&](const Shape& shape) {
            const auto grid = levelSet(shape);
            if (turnedLattice) grid->setTransform(rotatedTransform(1.0));
            return requireReference(*grid, atVoxels(voxels), Ties::Broken);
        };
        for (const Vec3d& centre : {Vec3d(0.0), Vec3d(0.5), Vec3d(0.5, 0, 0)}) {
            CHECK(meshed(sphere(centre, 6.3 * voxels)).destinationTies > 0);
            meshed(torus(centre, 6.2 * voxels, 2.6 * voxels));
        }
        // Ties but for values that are rounded differently.
        CHECK(meshed(sphere({1e-7, -5e-8, 3e-8}, 6.3 * voxels)).destinationTies > 0);
        // Faces that cut short edges in the middle.
        CHECK(meshed(box(Vec3d(-5.25 * voxels), Vec3d(5.25 * voxels))).halfTies > 0);
        meshed(box(Vec3d(-5.75 * voxels), Vec3d(5.75 * voxels)));
    }
    // Faces through the vertices of L_A and of L_B; only where the lattice's points are exact have they a
    // sign.
    for (const double halfEdge : {5.0, 5.5})
        requireReference(*levelSet(box(Vec3d(-halfEdge), Vec3d(halfEdge))), atVoxels(1.0), Ties::Broken);
}

TEST_CASE("the mesh is the reference's: affine transforms", "[reference]") {
    const auto transforms = {rotatedTransform(0.25), shearedTransform(0.25), mirroredTransform(0.25),
                             nonuniformTransform({0.25, 0.4, 0.3}),
                             uniformTransform(0.25, Vec3d(0.1, -3.3, 17.0))};
    for (const auto& transform : transforms) {
        const Vec3d centre = transform->indexToWorld(offCentre(33));
        for (const double voxels : {1.0, 1.6})
            requireReference(*levelSet(torus(centre, 1.7, 1.0), transform), atVoxels(voxels));
        requireReference(*levelSet(noiseBall(7, centre, 2.4, 1.8), transform), atVoxels(1.0));
    }
}

TEST_CASE("the mesh is the reference's: fog volumes and other isovalues", "[reference]") {
    const auto meshAt = [](const openvdb::FloatGrid& grid, double isovalue) {
        Options options;
        options.isovalue = isovalue;
        requireReference(grid, options);
    };
    const auto fog = fogVolume(torus(offCentre(41), 6, 2.6), uniformTransform(1.0));
    for (const double isovalue : {0.5, 0.3, 0.8}) meshAt(*fog, isovalue);
    const auto band = levelSet(torus(offCentre(42), 6, 2.6));
    for (const double isovalue : {-0.9, 0.6}) meshAt(*band, isovalue);
}

TEST_CASE("the mesh is the reference's: across tiles and nodes", "[reference]") {
    requireReference(*levelSet(torus(offCentre(51), 12, 4.3)), atVoxels(1.0));
    requireReference(*levelSet(twoBalls(offCentre(52), 5.2, 21)), atVoxels(1.0));
    requireReference(*levelSet(sphere(offCentre(53) + Vec3d(127.8, -128.1, 16.2), 7.3)), atVoxels(0.8));
}

TEST_CASE("the mesh is the reference's: version 3 on smooth shapes", "[reference]") {
    std::int64_t qualityFlips = 0;
    for (const double voxels : {1.0, 0.7, 2.0}) {
        for (const double tau : {0.5, 0.7}) {
            qualityFlips += requireThirdReference(*levelSet(sphere(offCentre(3), 5.3 * voxels)), voxels, tau)
                                .qualityFlips;
            requireThirdReference(*levelSet(torus(offCentre(11), 5 * voxels, 2.2 * voxels)), voxels, tau);
        }
        requireThirdReference(*levelSet(gyroidBall(offCentre(22), 9 * voxels, 9 * voxels, 3 * voxels)),
                              voxels);
    }
    CHECK(qualityFlips > 0);
}

TEST_CASE("the mesh is the reference's: version 3 on noise, with rounds of its guard", "[reference]") {
    std::int64_t flagged = 0, rounds = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        const ReferenceMesh mesh =
            requireThirdReference(*levelSet(noiseBall(seed, offCentre(seed), 11, 3)), 1.0);
        flagged += mesh.flagged;
        rounds = std::max(rounds, mesh.guardRounds);
    }
    for (const std::uint64_t seed : {1, 2, 3}) {
        const ReferenceMesh mesh = requireThirdReference(*randomCuts(10, seed, 0.7), 2.0);
        flagged += mesh.flagged;
        rounds = std::max(rounds, mesh.guardRounds);
    }
    CHECK(flagged > 100);
    CHECK(rounds > 1);
}
