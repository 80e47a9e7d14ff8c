/// @file make_fixtures.cc
/// Writes the .vdb files that the tests of vdb_tet read into the working directory: with --sequence those of
/// a sequence, with --hostile those that ask for too much or make no sense, else all others.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
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

/// A ball of a thin wall that meanders, finer in places than its voxels resolve.
openvdb::GridBase::Ptr lace(const std::string& name) {
    const double voxel = 0.1, wave = 0.19, width = 3.0 * voxel;
    const auto grid = openvdb::FloatGrid::create(float(width));
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    const openvdb::CoordBBox box(openvdb::Coord(-16), openvdb::Coord(16));
    for (auto at = box.begin(); at; ++at) {
        const openvdb::Vec3d p = grid->indexToWorld(*at), q = p / wave;
        const double gyroid = std::sin(q.x()) * std::cos(q.y()) + std::sin(q.y()) * std::cos(q.z()) +
                              std::sin(q.z()) * std::cos(q.x());
        const double distance = std::max(0.7 * wave * std::abs(gyroid) - 0.7 * voxel, p.length() - 1.2);
        grid->tree().setValue(*at, float(std::clamp(distance, -width, width)));
    }
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

/// Two balls that come out of each other, at a time from 0 to 1.
openvdb::GridBase::Ptr splitting(double time) {
    const auto ball = [&](double x) {
        return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(0.5f, openvdb::Vec3f(float(x), 0, 0),
                                                                        0.1f);
    };
    const auto grid = ball(0.3 - 0.8 * time);
    openvdb::tools::csgUnion(*grid, *ball(0.3 + 0.8 * time));
    grid->setName("drops");
    return grid;
}

void write(const std::string& path, const openvdb::GridCPtrVec& grids) {
    openvdb::io::File(path).write(grids);
}

/// frame.0001.vdb to frame.0024.vdb, of which the seventh is cut short.
void writeSequence() {
    constexpr int kFrames = 24;
    for (int frame = 1; frame <= kFrames; ++frame) {
        const std::string number = std::to_string(10000 + frame).substr(1);
        write("frame." + number + ".vdb", {splitting(double(frame - 1) / (kFrames - 1))});
    }
    std::filesystem::resize_file("frame.0007.vdb", 2000);
}

/// A constant tile of 4096 voxels an edge, or several, inside: a large surface, and a larger inside.
openvdb::GridBase::Ptr bomb(int tiles) {
    const auto grid = openvdb::FloatGrid::create(3.0f);
    grid->setName("bomb");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(tiles - 1));
    for (auto at = box.begin(); at; ++at)
        grid->tree().addTile(3, openvdb::Coord(4096 * (*at).x(), 4096 * (*at).y(), 4096 * (*at).z()), -3.0f,
                             true);
    return grid;
}

openvdb::GridBase::Ptr withTransform(const openvdb::math::Transform::Ptr& transform) {
    const auto grid = sphere(1.0f, "ball");
    grid->setTransform(transform);
    return grid;
}

/// The same ball in other places of index space.
openvdb::GridBase::Ptr shifted(const openvdb::Coord& by) {
    const auto from = sphere(1.0f, "ball"), to = from->copyWithNewTree();
    for (auto voxel = from->cbeginValueOn(); voxel; ++voxel)
        to->tree().setValueOn(voxel.getCoord() + by, *voxel);
    return to;
}

/// Files that are sound, and say what cannot be meant.
void writeHostile() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const auto holes = sphere(1.0f, "ball");
    for (const int x : {9, 10, 11}) holes->tree().setValueOn(openvdb::Coord(x, 0, 0), nan);
    write("nan.vdb", {holes});
    const auto nowhere = sphere(1.0f, "ball");
    nowhere->tree().root().setBackground(nan, false);
    write("nan_background.vdb", {nowhere});
    const auto inverse = sphere(1.0f, "ball");
    inverse->tree().root().setBackground(-0.3f, false);
    write("inside_background.vdb", {inverse});

    write("bomb_4096.vdb", {bomb(1)});
    write("bomb_16384.vdb", {bomb(4)});

    using openvdb::math::Transform;
    write("nan_transform.vdb", {withTransform(Transform::createLinearTransform(double(nan)))});
    write("infinite_transform.vdb", {withTransform(Transform::createLinearTransform(infinity))});
    const auto far = Transform::createLinearTransform(0.1);
    far->postTranslate(openvdb::Vec3d(1e15, 0, 0));
    write("far_transform.vdb", {withTransform(far)});
    write("ends.vdb", {shifted(openvdb::Coord(std::numeric_limits<int>::max() - 12, 0, 0))});

    const auto liar = sphere(1.0f, "ball");
    liar->insertMeta("file_bbox_min", openvdb::Vec3IMetadata(openvdb::Vec3i(2147483647)));
    liar->insertMeta("file_bbox_max", openvdb::Vec3IMetadata(openvdb::Vec3i(-2147483647)));
    liar->insertMeta("file_voxel_count", openvdb::Int64Metadata(-1));
    liar->insertMeta("file_mem_bytes", openvdb::StringMetadata("a lot"));
    liar->insertMeta("value_type", openvdb::StringMetadata("vec3s"));
    openvdb::io::File file("liar.vdb");
    file.setGridStatsMetadataEnabled(false);
    file.write(openvdb::GridCPtrVec{liar});
}

} // namespace

int main(int argc, char** argv) {
    openvdb::initialize();
    if (argc > 1 && std::string(argv[1]) == "--sequence") {
        writeSequence();
        return 0;
    }
    if (argc > 1 && std::string(argv[1]) == "--hostile") {
        writeHostile();
        return 0;
    }
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("vel");
    write("sphere.vdb", {sphere(1.0f, "ball")});
    write("far.vdb", {farSphere("ball")});
    write("fog.vdb", {fog("density")});
    write("vectors.vdb", {vectors});
    write("level_set_and_fog.vdb", {fog("density"), sphere(1.0f, "ball"), vectors});
    write("two_of_a_name.vdb", {sphere(1.0f, "ball"), sphere(0.5f, "ball")});
    write("two_unnamed.vdb", {sphere(1.0f, ""), sphere(0.5f, "")});
    write("lace.vdb", {lace("lace")});
    const auto hostile =
        sphere(1.0f, "</script><script>document.title = 'run'</script><img src=x onerror=stop()>\xff");
    hostile->setCreator("<!--<script>&amp;\u2028\"'");
    hostile->insertMeta("<b>key</b>", openvdb::StringMetadata("{{page.css}} <i>value</i>"));
    openvdb::MetaMap fileMetadata;
    fileMetadata.insertMeta("made by", openvdb::StringMetadata("</script>"));
    openvdb::io::File("hostile.vdb").write(openvdb::GridCPtrVec{hostile}, fileMetadata);
    openvdb::GridCPtrVec fields = {sphere(1.0f, "ball")};
    for (const auto& grid : linearFields()) fields.push_back(grid);
    write("fields.vdb", fields);
    return 0;
}
