/// @file make_sample.cc
/// Makes the project's sample: a level set of three balls melted into a ring, with a bore through the middle.
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

namespace {

using openvdb::Vec3d;

double smoothMin(double a, double b, double radius) {
    const double h = std::max(radius - std::abs(a - b), 0.0) / radius;
    return std::min(a, b) - 0.25 * h * h * radius;
}

/// About the signed distance to the sample's surface, in a unit of about a third of its width.
double sample(const Vec3d& p) {
    const double fromAxis = std::hypot(p.x(), p.y());
    double distance = std::hypot(fromAxis - 1.0, p.z()) - 0.25;
    for (int i = 0; i < 3; ++i) {
        const double angle = 2.0 * M_PI * i / 3.0;
        distance =
            smoothMin(distance, (p - Vec3d(std::cos(angle), std::sin(angle), 0.2)).length() - 0.45, 0.3);
    }
    distance = smoothMin(distance, p.length() - 0.6, 0.3);
    return std::max(distance, 0.2 - fromAxis);
}

} // namespace

int main(int argc, char** argv) try {
    if (argc != 2) {
        std::fprintf(stderr, "usage: vdbtet_sample OUT.vdb\n");
        return 2;
    }
    constexpr double voxel = 0.025;
    constexpr double halfWidth = 3.0 * voxel;
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(float(halfWidth));
    grid->setName("sample");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    auto accessor = grid->getAccessor();
    const openvdb::CoordBBox box(openvdb::Coord(-64, -64, -32), openvdb::Coord(64, 64, 36));
    for (auto i = box.begin(); i; ++i) {
        const double distance = sample(grid->indexToWorld(*i));
        if (std::abs(distance) < halfWidth) accessor.setValue(*i, float(distance));
    }
    openvdb::tools::signedFloodFill(grid->tree());
    openvdb::io::File(argv[1]).write({grid});
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "vdbtet_sample: %s\n", error.what());
    return 1;
}
