// How a file stores its values changes nothing.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"
#include "support/TempFolder.h"

#include <vdbtet/GridFile.h>

#include <openvdb/io/Compression.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/ChangeBackground.h>

using namespace vdbtet;
using namespace vdbtet::test;
namespace io = openvdb::io;

namespace {

std::vector<std::uint32_t> compressions() {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t mask : {0u, std::uint32_t(io::COMPRESS_ACTIVE_MASK)}) {
        result.push_back(io::COMPRESS_NONE | mask);
        result.push_back(io::COMPRESS_ZIP | mask);
        if (io::Archive::hasBloscCompression()) result.push_back(io::COMPRESS_BLOSC | mask);
    }
    if (!io::Archive::hasBloscCompression()) WARN("this OpenVDB has no Blosc; that half is not tested");
    return result;
}

void write(const std::string& path, const openvdb::GridBase::Ptr& grid, std::uint32_t compression) {
    io::File file(path);
    file.setCompression(compression);
    file.write({grid});
}

/// The values as a file holds them that saves floats as halves.
openvdb::FloatGrid::Ptr roundedToHalf(const openvdb::FloatGrid& grid) {
    const auto result = grid.deepCopy();
    openvdb::tools::changeBackground(result->tree(), io::truncateRealToHalf(grid.background()));
    for (auto it = result->beginValueAll(); it; ++it) it.setValue(io::truncateRealToHalf(*it));
    return result;
}

/// Every way of writing and reading a grid gives the mesh that the grid itself gives.
void requireSameFromFiles(const openvdb::FloatGrid::Ptr& grid) {
    const Meshed whole = meshOf(*grid), rounded = meshOf(*roundedToHalf(*grid));
    CHECK_FALSE(matchMeshes(whole.mesh, rounded.mesh, 1e-9).same);
    const TempFolder folder;
    for (const bool half : {false, true}) {
        const auto copy = grid->copy();
        copy->setSaveFloatAsHalf(half);
        for (const std::uint32_t compression : compressions()) {
            const std::string path = folder.file("grid.vdb");
            write(path, copy, compression);
            for (const bool delayLoad : {false, true}) {
                CAPTURE(half, io::compressionToString(compression), delayLoad);
                const Meshed read = meshOf(*readGrid(path, "", delayLoad));
                requireIdentical(read.mesh, half ? rounded.mesh : whole.mesh);
            }
        }
    }
}

} // namespace

TEST_CASE("any compression and half floats and delayed loading give the same mesh: level set") {
    requireSameFromFiles(levelSet(torus({0.3, -0.2, 0.1}, 17, 7)));
}

TEST_CASE("any compression and half floats and delayed loading give the same mesh: fog volume") {
    const auto fog = fogVolume(sphere({0.3, -0.2, 0.1}, 7), uniformTransform(0.5));
    requireSameFromFiles(fog);
}

TEST_CASE("a grid of doubles comes back from a file as one") {
    const auto floats = levelSet(sphere({0.3, -0.2, 0.1}, 9));
    auto doubles = openvdb::DoubleGrid::create(std::make_shared<openvdb::DoubleTree>(floats->tree()));
    doubles->setTransform(floats->transformPtr());
    doubles->setGridClass(floats->getGridClass());
    for (auto it = doubles->beginValueOn(); it; ++it) it.setValue(*it + 1e-9);
    const TempFolder folder;
    const std::string path = folder.file("grid.vdb");
    write(path, doubles, io::COMPRESS_ACTIVE_MASK);
    const auto read = readGrid(path);
    REQUIRE(read->isType<openvdb::DoubleGrid>());
    requireIdentical(meshOf(*read).mesh, meshOf(*doubles).mesh);
}
