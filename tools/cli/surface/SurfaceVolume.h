/// @file SurfaceVolume.h
/// The level set of a closed surface.
#pragma once

#include "SurfaceCheck.h"

#include <openvdb/openvdb.h>
#include <openvdb/util/NullInterrupter.h>

/// @brief Turn a surface into a level set by OpenVDB's meshToVolume().
/// @details Shells that face inwards and lie within others are cavities; all others count as solid, whichever
/// way they face. The same bytes whatever the number of threads.
/// @param voxel        the length of a voxel's edge, world units
/// @param interrupter  may be null; once it has said stop, what comes back is worth nothing
/// @return a level set named "surface", its half width three voxels
/// @throw vdbtet::BadOption where the voxels would be too many; vdbtet::NoSurface where nothing is enclosed
openvdb::FloatGrid::Ptr surfaceToVolume(const TriangleMesh& mesh, const SurfaceCheck& check, double voxel,
                                        openvdb::util::NullInterrupter* interrupter = nullptr);

/// @return the voxel's size where none is asked for: a 256th of the longest side.
double defaultVoxel(const TriangleMesh& mesh);
