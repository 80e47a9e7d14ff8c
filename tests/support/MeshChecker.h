/// @file MeshChecker.h
/// What a mesh must be, as checks of a test.
#pragma once

#include "support/MeshFigures.h"

#include <vdbtet/VolumeToTets.h>

namespace vdbtet::test {

/// An open interval of dihedral angles, degrees.
struct AngleBound {
    double lo, hi;
};
constexpr AngleBound kAlways{8.54, 164.18};      ///< whatever the surface (paper, eq. 21)
constexpr AngleBound kNoConflict{11.47, 157.59}; ///< version 2 without a conflict (paper, theorem 3)
constexpr AngleBound kLastResort{11.46, 157.59}; ///< version 2 with conflicts that are all flipped
constexpr AngleBound kGuarded{18.0, 146.0};      ///< version 3 where the guard has nothing to mend

/// Fails the running test where the mesh is not valid, is empty, or has an angle outside the bound.
MeshFigures requireClean(const TetMesh& mesh, const AngleBound& bound);

/// The same, and that the report tells the truth: its counts, its angles, and a bound that its run has
/// earned.
MeshFigures requireClean(const TetMesh& mesh, const Report& report);

/// Fails the running test where the boundary is not a surface. Only a surface that the lattice resolves is
/// sure to give one.
void requireManifold(const MeshFigures& figures);

} // namespace vdbtet::test
