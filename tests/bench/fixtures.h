/// @file fixtures.h
/// The solids that the benchmarks mesh, at any resolution.
#pragma once

#include <openvdb/openvdb.h>

namespace vdbtet::bench {

/// @brief A tilted torus with bumps, as a level set of half width 3.
/// @param resolution  voxels along its longest side, which is one world unit long
/// @details All of the shape scales with the resolution, so its surface grows with the square and its inside
/// with the cube of it. The tube is so thin that the mesh at 512 still fits into memory, twice.
openvdb::FloatGrid::Ptr bumpyTorus(int resolution);

/// A ball of @a resolution voxels across, as a level set of half width 3: the most inside a surface can have.
openvdb::FloatGrid::Ptr ball(int resolution);

/// A cube of @a resolution voxels, a multiple of 8, made of constant tiles: next to no surface, all interior.
openvdb::FloatGrid::Ptr box(int resolution);

} // namespace vdbtet::bench
