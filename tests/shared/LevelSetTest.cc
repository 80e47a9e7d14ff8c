// Level sets of scanned and CAD models, at spacings finer and coarser than their voxels.
#include "support/Catch.h"
#include "support/MeshChecker.h"
#include "support/Meshing.h"
#include "support/SharedData.h"

#include <vdbtet/GridFile.h>

#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <vector>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

/// The files whose names end in @a resolution.
std::vector<std::filesystem::path> levelSets(const std::string& resolution) {
    std::vector<std::filesystem::path> result;
    const auto folder = sharedPath("data/levelset");
    if (!folder) return result;
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
        const std::string stem = entry.path().stem().string();
        const std::size_t ending = stem.rfind('_' + resolution);
        if (ending != std::string::npos && ending + resolution.size() + 1 == stem.size())
            result.push_back(entry.path());
    }
    std::sort(result.begin(), result.end());
    REQUIRE_FALSE(result.empty());
    return result;
}

/// The greatest distance of a boundary point from the trilinear isosurface, in voxels: a point that is on no
/// lattice vertex has moved there.
double farthestFromSurface(const Meshed& result, const openvdb::FloatGrid& grid) {
    double farthest = 0;
    for (const openvdb::Vec3d& p : result.mesh.points) {
        const openvdb::Vec3d lattice =
            2.0 * (p - grid.indexToWorld(openvdb::Vec3d(0.0))) / result.report.spacing;
        double off = 0;
        for (int axis = 0; axis < 3; ++axis)
            off = std::max(off, std::abs(lattice[axis] - std::round(lattice[axis])));
        if (off < 1e-6) continue;
        const double value = openvdb::tools::BoxSampler::sample(grid.tree(), grid.worldToIndex(p));
        farthest = std::max(farthest, std::abs(value));
    }
    return farthest / result.report.voxelSize;
}

void requireCleanLevelSets(const std::string& resolution, double voxels, bool grade = false) {
    for (const auto& path : levelSets(resolution)) {
        CAPTURE(path.filename().string(), voxels);
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(readGrid(path.string()));
        Options options = atVoxels(voxels);
        options.grade = grade;
        const Meshed result = meshOf(*grid, options);
        const MeshFigures figures = requireClean(result.mesh, result.report);
        CHECK(figures.volume > 0);
        CHECK(farthestFromSurface(result, *grid) < 0.01);
    }
}

} // namespace

TEST_CASE("level sets of 64 voxels across give clean meshes", "[shared]") {
    for (const double voxels : {1.0, 2.0, 5.0}) requireCleanLevelSets("64", voxels);
}

TEST_CASE("level sets of 64 voxels across give clean meshes on a finer lattice", "[shared]") {
    requireCleanLevelSets("64", 0.7);
}

TEST_CASE("level sets of 128 voxels across give clean meshes on a coarser lattice", "[shared]") {
    for (const double voxels : {2.0, 5.0}) requireCleanLevelSets("128", voxels);
}

TEST_CASE("level sets give clean graded meshes", "[shared][grading]") {
    for (const double voxels : {0.7, 1.0, 3.0}) requireCleanLevelSets("64", voxels, true);
    requireCleanLevelSets("128", 1.0, true);
    requireCleanLevelSets("256", 2.0, true);
}

TEST_CASE("level sets of 128 voxels across give clean meshes", "[shared][slow]") {
    for (const double voxels : {0.7, 1.0}) requireCleanLevelSets("128", voxels);
}

TEST_CASE("level sets of 256 voxels across give clean meshes on a coarser lattice", "[shared][slow]") {
    for (const double voxels : {2.0, 5.0}) requireCleanLevelSets("256", voxels);
}

TEST_CASE("level sets of 256 voxels across give clean meshes", "[shared][slow]") {
    requireCleanLevelSets("256", 1.0);
}
