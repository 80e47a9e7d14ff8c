// The reference mesher itself: the paper's Table 1, and the two ways to its labels.
#include "reference/ReferenceMesher.h"
#include "reference/GridField.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// The paper's set-up: 31 lattice points an axis over the unit cube.
ReferenceMesh meshUnitCube(const Shape& shape, int tiger) {
    constexpr double spacing = 1 / 30.0;
    const Phi phi = [&](const Vec3d& p) { return -shape.distance(spacing * p); };
    return referenceMesh(phi, openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(30)), tiger);
}

MeshFigures requireCleanReference(const ReferenceMesh& mesh, const AngleBound& bound) {
    TetMesh copy;
    copy.points = mesh.points;
    copy.tets = mesh.tets;
    return requireClean(copy, bound);
}

std::int64_t countDifferences(const DenseLattice& lattice, const Labels& a, const Labels& b) {
    std::int64_t count = 0;
    for (const auto* side : {&lattice.verticesA(), &lattice.verticesB()})
        for (const Vertex v : *side) count += a.move[v] != b.move[v];
    return count;
}

} // namespace

TEST_CASE("the reference mesher reproduces the paper's Table 1", "[reference]") {
    for (const int tiger : {1, 2}) {
        const MeshFigures ball =
            requireCleanReference(meshUnitCube(sphere(Vec3d(0.5), 0.13), tiger), kNoConflict);
        CHECK(ball.tets == 2904);
        CHECK(ball.triangles == 552);
        CHECK(ball.minAngle == Approx(23.242).margin(0.001));
        CHECK(ball.maxAngle == Approx(122.241).margin(0.001));
        CHECK(ball.euler == 2);

        const MeshFigures ring = requireCleanReference(meshUnitCube(paperTorus(), tiger), kNoConflict);
        CHECK(ring.tets == 8012);
        CHECK(ring.triangles == 1640);
        CHECK(ring.minAngle == Approx(20.604).margin(0.001));
        CHECK(ring.maxAngle == Approx(151.557).margin(0.001));
        CHECK(ring.euler == 0);
    }
}

TEST_CASE("the paper's search finds the kernel wherever it is unique", "[reference]") {
    int unique = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const auto grid = randomCuts(3, seed);
        const GridField field(*grid, 0.0, Inside::Below, 2.0);
        const DenseLattice lattice(field.box(), field.phi());
        REQUIRE(lattice.manyRoots == 0);
        const Labels searched = searchedLabels(lattice), kernel = kernelLabels(lattice);
        CAPTURE(seed, kernel.undecided);
        if (kernel.undecided > 0) continue;
        ++unique;
        CHECK(countDifferences(lattice, searched, kernel) == 0);
    }
    CHECK(unique >= 10);
}

TEST_CASE("random cuts give valid reference meshes in the bound that holds always", "[reference]") {
    ReferenceMesh sum;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto grid = randomCuts(12, seed, 0.7);
        const GridField field(*grid, 0.0, Inside::Below, 2.0);
        for (const Labelling labelling : {Labelling::Search, Labelling::Kernel}) {
            const ReferenceMesh mesh = referenceMesh(field.phi(), field.box(), 2, labelling);
            requireCleanReference(mesh, mesh.conflicts == 0 ? kNoConflict : kAlways);
            sum.activeFlips += mesh.activeFlips;
            sum.extraFlips += mesh.extraFlips;
            sum.lastResortFlips += mesh.lastResortFlips;
            sum.conflicts += mesh.conflicts;
            sum.ambiguous += mesh.ambiguous;
        }
    }
    CHECK(sum.activeFlips > 0);
    CHECK(sum.conflicts > 0);
    CHECK(sum.ambiguous > 0);
    CHECK(sum.extraFlips > 0);
    CHECK(sum.lastResortFlips > 0);
}
