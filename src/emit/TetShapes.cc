/// @file TetShapes.cc
/// The smallest of six angles.
#include "emit/TetShapes.h"

#include "quality/Dihedral.h"

#include <algorithm>

namespace vdbtet {

float TetShapes::minDihedral(const std::array<openvdb::Vec3d, 4>& corners) {
    const auto cosines = dihedralCosines(corners[0], corners[1], corners[2], corners[3]);
    return float(angleOf(*std::max_element(cosines.begin(), cosines.end())));
}

} // namespace vdbtet
