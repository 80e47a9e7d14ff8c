/// @file SignedDistance.h
/// How far from the surface it is.
#pragma once

#include <vdbtet/VolumeToTets.h>

#include <openvdb/Grid.h>
#include <openvdb/util/NullInterrupter.h>

#include <optional>

namespace vdbtet {

/// @brief Make a grid of signed distances to the surface that volumeToTets() meshes, for a FieldSampler.
/// @param grid       a FloatGrid or DoubleGrid, such as a fog volume or a level set of a narrower band
/// @param options    as for volumeToTets(); only isovalue, inside and nan matter
/// @param halfWidth  world length: deeper inside the values are -halfWidth. Default: 3 of the shortest edges
///                   of a voxel
/// @return a level set named "distance" of that half-width: world units, negative inside. The transform is
/// the grid's, moved by whole voxels; where voxels are no cubes it has cubes of their shortest edge.
/// @details As OpenVDB's levelSetRebuild() does it, by polygons, but with the grid's own signs, and on one
/// thread, so that the values are the same on every run. Few of them are off by up to half a voxel, two
/// voxels from the surface and deeper. There is no surface between inactive tiles. Memory grows with the
/// band, on both sides of the surface.
/// @throw BadOption, UnsupportedGrid, BadValue, NoSurface, UnboundedInside
openvdb::GridBase::Ptr signedDistance(const openvdb::GridBase& grid, const Options& options = {},
                                      std::optional<double> halfWidth = {},
                                      openvdb::util::NullInterrupter* interrupter = nullptr);

} // namespace vdbtet
