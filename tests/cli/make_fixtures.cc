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
    return 0;
}
