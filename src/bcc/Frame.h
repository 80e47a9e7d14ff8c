/// @file Frame.h
/// Where the lattice lies: its map to world space and to the grid's index space.
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Transform.h>

namespace vdbtet {

/// @brief The placement of the lattice in world space.
/// @details Regular in world space whatever the voxel's shape: a rotation times the spacing. L_A's vertex
/// (0,0,0) is the centre of voxel (0,0,0). The axes follow the voxel's as far as a right-handed orthonormal
/// frame can (Gram-Schmidt; the third one is reversed under a mirrored transform), so with cubic voxels and c
/// = one voxel L_A is the voxel centres.
struct Frame {
    double spacing;           ///< c, world units
    openvdb::Vec3d origin;    ///< world position of the lattice's origin
    openvdb::Mat3d toWorld;   ///< lattice units to world, without the origin: c times a rotation
    openvdb::Mat3d toIndex;   ///< lattice units to index space; the origin is voxel (0,0,0)
    openvdb::Mat3d fromIndex; ///< the inverse of toIndex

    openvdb::Vec3d world(const openvdb::Vec3d& lattice) const { return toWorld * lattice + origin; }
};

/// @return the world length of the shortest edge of a voxel.
/// @throw UnsupportedGrid where the transform is not affine, or an edge is zero or not finite
double shortestVoxelEdge(const openvdb::math::Transform& transform);

/// @throw UnsupportedGrid where the transform is not affine, or is singular or not finite
/// @throw BadOption where @a spacing is not a positive finite length
Frame makeFrame(const openvdb::math::Transform& transform, double spacing);

} // namespace vdbtet
