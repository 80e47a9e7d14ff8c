/// @file make_fixtures.cc
/// Writes the .vdb files that the tests of vdb_tet read into the working directory.
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <string>

namespace {

openvdb::FloatGrid::Ptr sphere(float radius, const std::string& name) {
    const auto grid =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, openvdb::Vec3f(0), 0.1f);
    grid->setName(name);
    return grid;
}

openvdb::GridBase::Ptr fog(const std::string& name) {
    const auto grid = sphere(0.8f, name);
    openvdb::tools::sdfToFogVolume(*grid);
    return grid;
}

/// So far from the origin that float32 is too coarse for its coordinates.
openvdb::GridBase::Ptr farSphere(const std::string& name) {
    const auto grid = sphere(1.0f, name);
    grid->transform().postTranslate(openvdb::Vec3d(1e6, -2e6, 3e6));
    return grid;
}

/// @return a grid of voxels of 0.15 around the sphere, whose values are @a value(index coordinates).
template <typename GridT, typename ValueF>
typename GridT::Ptr field(const std::string& name, const ValueF& value) {
    const auto grid = GridT::create();
    grid->setName(name);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.15));
    const openvdb::CoordBBox box(openvdb::Coord(-10), openvdb::Coord(10));
    for (auto at = box.begin(); at; ++at) grid->tree().setValue(*at, value(*at));
    return grid;
}

/// Linear fields, in world coordinates x, y, z.
openvdb::GridPtrVec linearFields() {
    using openvdb::Coord;
    const auto heat = field<openvdb::FloatGrid>("heat & <light>", [](const Coord& at) { // 2 x - y + z / 2 + 3
        return float(0.15 * (2.0 * at.x() - at.y() + 0.5 * at.z()) + 3.0);
    });
    const auto count = field<openvdb::Int32Grid>("count", [](const Coord& at) { // (x + 2 y - 3 z) / 0.15
        return at.x() + 2 * at.y() - 3 * at.z();
    });
    const auto vel = field<openvdb::Vec3SGrid>("vel", [](const Coord& at) { // (x, 2 y, 3 z)
        // Each component on the lower face of the voxel.
        return openvdb::Vec3f(0.15f * (float(at.x()) - 0.5f), 0.3f * (float(at.y()) - 0.5f),
                              0.45f * (float(at.z()) - 0.5f));
    });
    vel->setGridClass(openvdb::GRID_STAGGERED);
    return {heat, count, vel};
}

void write(const std::string& path, const openvdb::GridCPtrVec& grids) {
    openvdb::io::File(path).write(grids);
}

} // namespace

int main() {
    openvdb::initialize();
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("vel");
    write("sphere.vdb", {sphere(1.0f, "ball")});
    write("far.vdb", {farSphere("ball")});
    write("fog.vdb", {fog("density")});
    write("vectors.vdb", {vectors});
    write("level_set_and_fog.vdb", {fog("density"), sphere(1.0f, "ball"), vectors});
    write("two_of_a_name.vdb", {sphere(1.0f, "ball"), sphere(0.5f, "ball")});
    write("two_unnamed.vdb", {sphere(1.0f, ""), sphere(0.5f, "")});
    openvdb::GridCPtrVec fields = {sphere(1.0f, "ball")};
    for (const auto& grid : linearFields()) fields.push_back(grid);
    write("fields.vdb", fields);
    return 0;
}
