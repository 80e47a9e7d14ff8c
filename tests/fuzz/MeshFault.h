/// @file MeshFault.h
/// The suite's judgement of a mesh and its report, in words instead of a failed test.
#pragma once

#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <string>

namespace vdbtet::test {

/// @return what is wrong with a mesh, or with what its report says of it; empty if nothing is
std::string meshFault(const TetMesh& mesh, const Report& report);

} // namespace vdbtet::test
