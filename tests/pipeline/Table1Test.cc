// The paper's Table 1, through .vdb files.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"
#include "support/TempFolder.h"

#include <vdbtet/GridFile.h>

#include <openvdb/io/File.h>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

constexpr double kSpacing = 1 / 30.0;

/// Writes the shape as a level set, reads it again, and meshes it at the paper's spacing.
Meshed meshThroughFile(const Shape& shape, double voxel, int tiger) {
    const TempFolder folder;
    const std::string path = folder.file("shape.vdb");
    openvdb::io::File(path).write({levelSet(shape, voxel)});
    Options options;
    options.spacing = kSpacing;
    options.tiger = tiger;
    return meshOf(*readGrid(path), options);
}

} // namespace

TEST_CASE("a level set of a quarter of the spacing gives the paper's sphere") {
    for (const int tiger : {1, 2}) {
        const Meshed result = meshThroughFile(sphere(Vec3d(0.5), 0.13), kSpacing / 4, tiger);
        const MeshFigures f = requireClean(result.mesh, result.report);
        requireManifold(f);
        CHECK(f.tets == 2904);
        CHECK(f.triangles == 552);
        CHECK(f.euler == 2);
        CHECK(result.report.conflicts == 0);
    }
}

TEST_CASE("a level set of a quarter of the spacing gives the paper's torus") {
    for (const int tiger : {1, 2}) {
        const Meshed result = meshThroughFile(paperTorus(), kSpacing / 4, tiger);
        const MeshFigures f = requireClean(result.mesh, result.report);
        requireManifold(f);
        CHECK(f.tets == 8012);
        CHECK(f.triangles == 1640);
        CHECK(f.euler == 0);
        CHECK(result.report.conflicts == 0);
    }
}

TEST_CASE("the paper's angles come out of a fine level set") {
    // The interpolant's error falls with the square of the voxel, and the angles' with it.
    const Meshed ball = meshThroughFile(sphere(Vec3d(0.5), 0.13), kSpacing / 32, 2);
    CHECK(ball.report.tets == 2904);
    CHECK(ball.report.angles.min == Approx(23.242).margin(0.01));
    CHECK(ball.report.angles.max == Approx(122.241).margin(0.01));
    const Meshed ring = meshThroughFile(paperTorus(), kSpacing / 16, 2);
    CHECK(ring.report.tets == 8012);
    CHECK(ring.report.angles.min == Approx(20.604).margin(0.01));
    CHECK(ring.report.angles.max == Approx(151.557).margin(0.01));
}
