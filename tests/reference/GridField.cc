// Copies a grid to double precision and samples it with OpenVDB's own interpolator.
#include "reference/GridField.h"

#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <stdexcept>

namespace vdbtet::test {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::DoubleGrid;
using openvdb::FloatGrid;

Vec3d LatticeFrame::toWorld(const Vec3d& p) const {
    return origin + spacing * (p[0] * x + p[1] * y + p[2] * z);
}

Vec3d LatticeFrame::toLattice(const Vec3d& world) const {
    const Vec3d p = (world - origin) / spacing;
    return {p.dot(x), p.dot(y), p.dot(z)};
}

LatticeFrame latticeFrame(const openvdb::math::Transform& transform, double spacing) {
    const Vec3d origin = transform.indexToWorld(Vec3d(0.0));
    const auto axis = [&](const Vec3d& ijk) { return transform.indexToWorld(ijk) - origin; };
    const Vec3d x = axis({1, 0, 0}).unit();
    Vec3d y = axis({0, 1, 0});
    y = (y - y.dot(x) * x).unit();
    return {origin, x, y, x.cross(y), spacing};
}

GridField::GridField(const openvdb::GridBase& grid, double isovalue, Inside inside, double spacing)
    : mIsovalue(isovalue), mInside(inside), mFrame(latticeFrame(grid.transform(), spacing)) {
    if (grid.isType<DoubleGrid>()) {
        mGrid = static_cast<const DoubleGrid&>(grid).deepCopy();
    } else if (grid.isType<FloatGrid>()) {
        const auto& tree = static_cast<const FloatGrid&>(grid).tree();
        mGrid = DoubleGrid::create(std::make_shared<openvdb::DoubleTree>(tree));
        mGrid->setTransform(grid.transform().copy());
    } else {
        throw std::logic_error("the reference mesher needs a float or double grid");
    }
}

Phi GridField::phi() const {
    return [this, accessor = mGrid->getConstAccessor()](const Vec3d& lattice) {
        const Vec3d ijk = mGrid->transform().worldToIndex(mFrame.toWorld(lattice));
        const double value = openvdb::tools::BoxSampler::sample(accessor, ijk);
        return mInside == Inside::Below ? mIsovalue - value : value - mIsovalue;
    };
}

CoordBBox GridField::box() const {
    CoordBBox leaves;
    mGrid->tree().evalLeafBoundingBox(leaves);
    const CoordBBox active = mGrid->evalActiveVoxelBoundingBox();
    if (!active.empty()) leaves.expand(active);
    openvdb::BBoxd lattice;
    for (int corner = 0; corner < 8; ++corner) {
        const auto pick = [&](int axis) {
            return corner >> axis & 1 ? leaves.max()[axis] + 1.0 : leaves.min()[axis] - 1.0;
        };
        lattice.expand(mFrame.toLattice(mGrid->transform().indexToWorld(Vec3d(pick(0), pick(1), pick(2)))));
    }
    CoordBBox box(Coord::floor(lattice.min()), Coord::ceil(lattice.max()));
    box.expand(3);
    return box;
}

} // namespace vdbtet::test
