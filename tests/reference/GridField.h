/// @file GridField.h
/// Shows a VDB grid to the reference mesher: as a function of lattice coordinates, and the box of its
/// lattice.
#pragma once

#include "reference/DenseLattice.h"

#include <vdbtet/VolumeToTets.h>

namespace vdbtet::test {

/// Where the lattice lies in the world: L_A is at origin + spacing * (i * x + j * y + k * z).
struct LatticeFrame {
    Vec3d origin;
    Vec3d x, y, z; ///< orthonormal and right-handed
    double spacing;

    Vec3d toWorld(const Vec3d& lattice) const;
    Vec3d toLattice(const Vec3d& world) const;
};

/// The frame of a grid: the Gram-Schmidt basis of its index axes, turned right-handed by negating the third.
LatticeFrame latticeFrame(const openvdb::math::Transform& transform, double spacing);

/// A scalar grid's trilinear interpolant in double precision.
class GridField {
public:
    /// @param inside  Below or Above
    GridField(const openvdb::GridBase& grid, double isovalue, Inside inside, double spacing);

    const LatticeFrame& frame() const { return mFrame; }
    /// >= 0 inside.
    Phi phi() const;
    /// A box of L_A around every leaf and active tile.
    openvdb::CoordBBox box() const;

private:
    openvdb::DoubleGrid::Ptr mGrid;
    double mIsovalue;
    Inside mInside;
    LatticeFrame mFrame;
};

} // namespace vdbtet::test
