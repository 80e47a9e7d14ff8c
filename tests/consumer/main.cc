#include <openvdb/tools/LevelSetSphere.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

int main() {
    const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, openvdb::Vec3f(0), 0.1f);
    vdbtet::TetMesh mesh;
    vdbtet::volumeToTets(*grid, mesh);
    return mesh.tets.empty() ? 1 : 0;
}
