// The fast mesher gives the reference mesher's mesh, tet for tet.
#include "reference/GridField.h"
#include "reference/ReferenceMesher.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Cut points are found to far better than this part of the spacing.
constexpr double kPrecision = 1e-7;

ReferenceMesh requireReference(const openvdb::GridBase& grid, const Options& options,
                               Labelling labelling = Labelling::Search) {
    const Meshed fast = meshOf(grid, options);
    const GridField field(grid, fast.report.isovalue, fast.report.inside, fast.report.spacing);
    const ReferenceMesh slow = referenceMesh(field.phi(), field.box(), options.tiger, labelling);
    INFO("spacing " << fast.report.spacing << ", version " << options.tiger);

    // A fixture where the method has more than one right answer proves nothing.
    REQUIRE(slow.manyRoots == 0);
    REQUIRE(slow.halfTies == 0);
    if (labelling == Labelling::Search) REQUIRE(slow.undecided == 0);
    REQUIRE(slow.sliceTies == 0);
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
        for (const double thickness : {3.0, 1.2})
            requireReference(*levelSet(gyroidBall(offCentre(21), 9 * voxels, 9 * voxels, thickness * voxels)),
                             atVoxels(voxels));
}

TEST_CASE("the mesh is the reference's: noise", "[reference]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        requireReference(*levelSet(noiseBall(seed, offCentre(seed), 11, 4)),
                         atVoxels(1.0, 1 + int(seed % 2)));
}

TEST_CASE("the mesh is the reference's: random signs", "[reference]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
        requireReference(*randomCuts(7, seed), atVoxels(2.0), Labelling::Kernel);
}

TEST_CASE("the mesh is the reference's: affine transforms", "[reference]") {
    const auto transforms = {rotatedTransform(0.25), shearedTransform(0.25), mirroredTransform(0.25),
                             nonuniformTransform({0.25, 0.4, 0.3}),
                             uniformTransform(0.25, Vec3d(0.1, -3.3, 17.0))};
    for (const auto& transform : transforms) {
        const Vec3d centre = transform->indexToWorld(offCentre(31));
        for (const double voxels : {1.0, 1.6}) {
            requireReference(*levelSet(torus(centre, 1.7, 0.8), transform), atVoxels(voxels));
            requireReference(*levelSet(noiseBall(5, centre, 2.2, 1.1), transform), atVoxels(voxels));
        }
    }
}

TEST_CASE("the mesh is the reference's: fog volumes and other isovalues", "[reference]") {
    const auto transform = uniformTransform(1.0);
    const auto fog = fogVolume(torus(offCentre(41), 6, 2.6), transform);
    for (const double iso : {0.5, 0.3, 0.8}) {
        Options options;
        options.isovalue = iso;
        requireReference(*fog, options);
    }
    const auto band = levelSet(torus(offCentre(42), 6, 2.6));
    for (const double iso : {-0.9, 0.6}) {
        Options options;
        options.isovalue = iso;
        requireReference(*band, options);
    }
}

TEST_CASE("the mesh is the reference's: several tiles", "[reference]") {
    requireReference(*levelSet(torus(offCentre(51), 12, 4.3)), atVoxels(1.0));
    requireReference(*levelSet(twoBalls(offCentre(52), 5.2, 21)), atVoxels(1.0));
    requireReference(*levelSet(sphere(offCentre(53) + Vec3d(-7.8, 8.1, 16.2), 7.3)), atVoxels(0.8));
}
