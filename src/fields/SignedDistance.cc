/// @file SignedDistance.cc
/// The surface as polygons, and the distances to these.
#include <vdbtet/SignedDistance.h>

#include <vdbtet/Errors.h>

#include "ChooseLevel.h"
#include "bcc/Frame.h"
#include "field/FiniteGrid.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/ValueTransformer.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbtet {

namespace {

using openvdb::Mat4d;
using openvdb::Vec3d;
using openvdb::math::Transform;

/// Less of a band than this has no value at some corner of a voxel that the surface crosses.
constexpr double kLeastVoxels = 3.0;

/// A linear transform without its translation.
Mat4d linearPart(const Transform& transform) {
    Mat4d part = transform.baseMap()->getAffineMap()->getMat4();
    part.setTranslation(Vec3d(0.0));
    return part;
}

template <typename GridT>
typename GridT::Ptr distanceTo(const GridT& grid, const Level& level, double voxel, double width,
                               openvdb::util::NullInterrupter* interrupter) {
    using Value = typename GridT::ValueType;
    // OpenVDB makes polygons of float32, so the grid is worked on where they are finest: at the origin.
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    const openvdb::Coord centre = box.empty() ? openvdb::Coord() : openvdb::Coord::floor(box.getCenter());
    const Mat4d linear = linearPart(grid.transform());
    const auto voxels = Transform::createLinearTransform(linear);
    const auto cubes = voxels->hasUniformScale() ? voxels : Transform::createLinearTransform(voxel);
    const auto moved = Transform::createLinearTransform(linear);
    moved->preTranslate(-centre.asVec3d());
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*grid.copyReplacingMetadataAndTransform(openvdb::MetaMap(), moved), points,
                                 quads, level.isovalue);
    for (openvdb::Vec3s& p : points) p = openvdb::Vec3s(cubes->worldToIndex(p));

    // No place inside is farther from the surface than half the grid's least extent.
    double deepest = 0.0;
    if (!box.empty()) {
        const Vec3d edges = grid.transform().voxelSize(), dim = box.dim().asVec3d();
        deepest = 0.5 * std::min({dim.x() * edges.x(), dim.y() * edges.y(), dim.z() * edges.z()}) / voxel;
    }
    const double band = std::max(kLeastVoxels, std::min(width / voxel, deepest) + 1.0);
    // Without signs: OpenVDB's are by what can be reached from outside, and cavities would be lost. And on
    // one thread: which of two polygons equally near counts may depend on the threads, and farther voxels
    // follow it.
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> surface(points, quads);
    openvdb::util::NullInterrupter none;
    typename GridT::Ptr result;
    tbb::task_arena(1).execute([&] {
        result = openvdb::tools::meshToVolume<GridT>(interrupter ? *interrupter : none, surface, *cubes,
                                                     float(band), float(band),
                                                     openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    });
    result->transform().postTranslate(grid.transform().indexToWorld(centre));
    const openvdb::tools::GridSampler<GridT, openvdb::tools::BoxSampler> original(grid);
    openvdb::tools::foreach (result->beginValueOn(), [&](const typename GridT::ValueOnIter& it) {
        const Vec3d at = result->transform().indexToWorld(it.getCoord());
        const double distance = std::min(std::abs(double(*it)), width);
        it.setValue(Value(level.phi(double(original.wsSample(at))) >= 0.0 ? -distance : distance));
    });
    openvdb::tools::signedFloodFillWithValues(result->tree(), Value(width), Value(-width));
    return result;
}

template <typename GridT>
openvdb::GridBase::Ptr makeDistance(const GridT& grid, const Options& options,
                                    std::optional<double> halfWidth,
                                    openvdb::util::NullInterrupter* interrupter) {
    const double voxel = shortestVoxelEdge(grid.transform()), width = halfWidth.value_or(3.0 * voxel);
    if (!(width > 0.0) || !std::isfinite(width))
        throw BadOption("the width of a distance's band must be a positive length");
    Report report;
    const Level level = chooseLevel(grid, double(grid.background()), options, report);
    Interrupt none(nullptr); // looking at the values takes no time next to the rest
    const FiniteGrid<GridT> finite(grid, level, options.nan, none);
    requireInside(finite.values(), level);
    const typename GridT::Ptr result = distanceTo(finite.grid(), level, voxel, width, interrupter);
    if (result->activeVoxelCount() == 0 && !(interrupter && interrupter->wasInterrupted())) {
        throw NoSurface("OpenVDB finds no surface to measure distances from; activate the values around it");
    }
    result->setName("distance");
    result->setGridClass(openvdb::GRID_LEVEL_SET);
    return result;
}

} // namespace

openvdb::GridBase::Ptr signedDistance(const openvdb::GridBase& grid, const Options& options,
                                      std::optional<double> halfWidth,
                                      openvdb::util::NullInterrupter* interrupter) {
    try {
        if (const auto* floats = dynamic_cast<const openvdb::FloatGrid*>(&grid))
            return makeDistance(*floats, options, halfWidth, interrupter);
        if (const auto* doubles = dynamic_cast<const openvdb::DoubleGrid*>(&grid))
            return makeDistance(*doubles, options, halfWidth, interrupter);
        throw UnsupportedGrid("a grid of type " + grid.type() +
                              " has no distances; only float and double grids have");
    } catch (Error& error) {
        error.prefix(quoted(grid));
        throw;
    }
}

} // namespace vdbtet
