// Two thousand random shapes, places, transforms and spacings: each mesh is clean, and within the bounds that
// its report states, which are those that vdbtet_prove proves.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <cmath>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// Waves of some length on a plane, cut off by a box.
Shape waves(Random& random) {
    const double length = random.uniform(3.0, 9.0), height = random.uniform(0.2, 1.5);
    const Vec3d phase = random.inBox(0.0, 6.28);
    Shape shape = box(Vec3d(-7.0), Vec3d(7.0));
    shape.distance = [=, inBox = shape.distance](const Vec3d& p) {
        const double z = height * (std::sin(6.28 * p.x() / length + phase.x()) *
                                   std::cos(6.28 * p.y() / length + phase.y()));
        return std::max(inBox(p), 0.7 * (p.z() - z));
    };
    return shape;
}

Shape randomShape(Random& random) {
    const Vec3d centre = random.inBox(-0.5, 0.5);
    switch (random.next() % 6) {
    case 0:
        return sphere(centre, random.uniform(1.5, 9.0));
    case 1:
        return torus(centre, random.uniform(5.0, 9.0), random.uniform(1.2, 4.0));
    case 2:
        return gyroidBall(centre, 8.0, random.uniform(6.0, 14.0), random.uniform(1.5, 4.0));
    case 3:
        return box(centre - random.inBox(2.0, 7.0), centre + random.inBox(2.0, 7.0));
    case 4:
        return waves(random);
    default:
        return noiseBall(random.next(), centre, 8.0, random.uniform(1.5, 5.0));
    }
}

/// A rotation by a random unit quaternion, and a shift.
openvdb::math::Transform::Ptr randomTransform(Random& random) {
    Vec3d axis = random.inBox(-1.0, 1.0);
    axis.normalize();
    const double angle = random.uniform(0.0, 3.14);
    const auto turned = [&](const Vec3d& v) { // Rodrigues' formula
        return std::cos(angle) * v + std::sin(angle) * axis.cross(v) +
               (1.0 - std::cos(angle)) * axis.dot(v) * axis;
    };
    return affineTransform(turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), random.inBox(-0.5, 0.5));
}

} // namespace

TEST_CASE("two thousand random shapes keep the bounds of each version", "[property][slow]") {
    Random random(20131);
    int meshes = 0;
    for (int i = 0; i < 2000; ++i) {
        const int tiger = 1 + i % 3;
        const double voxels = random.uniform(0.8, 2.2);
        const auto grid = levelSet(randomShape(random), randomTransform(random));
        CAPTURE(i, tiger, voxels);
        try {
            const Meshed result = meshOf(*grid, atVoxels(voxels, tiger));
            requireClean(result.mesh, result.report);
            ++meshes;
        } catch (const NoSurface&) { // thinner than the lattice
        }
    }
    CHECK(meshes > 1900);
}
