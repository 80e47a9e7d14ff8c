/// @file Slices.h
/// How good the tets of an octahedron's slice are, and which of two slices is the better one (paper,
/// Algorithm 4).
#pragma once

#include "destinations/LocalVertices.h"
#include "simd/Isa.h"

#include <vector>

namespace vdbtet {

/// The extremes over the tets of a slice that will be in the mesh; cosines fall as angles grow.
struct SliceQuality {
    bool inverted = false;
    double minCos = 1.0, maxCos = -1.0;
};

/// @return the quality of one slice of any octahedron.
SliceQuality sliceQuality(const LocalVertices& vertices, const LocalOctahedron& octahedron, bcc::Slice slice);

constexpr double kMinAngle = 11.47; ///< degrees; the policy of Algorithm 4
constexpr double kTieAngle = 1e-5;  ///< degrees; more than distances in float can turn an angle

/// The policy of Algorithm 4, made safe against inverted tets and rounding.
bool better(const SliceQuality& a, const SliceQuality& b);

/// @brief What version 3 takes for the quality of some tets, in degrees: the sharpest angle, or how far the
/// widest one is from 180 if that, times 0.54, is less; 0 where any is inverted.
double worth(const SliceQuality& quality);

/// Which of the slices of an active octahedron is the better one.
enum class SliceRule {
    Policy, ///< of Algorithm 4
    Worth   ///< of version 3
};

/// @brief Algorithm 4: the slices of octahedra whose spines join an inside and an outside vertex.
/// @details Decides by the two tets at the inside end alone: the whole ring is manifold, for each of its
/// vertices has a cut edge to an end that is not. Ties within 1e-5 degrees go to the other criterion, then to
/// slice A.
void chooseActiveSlices(const LocalVertices& vertices, const std::vector<LocalOctahedron>& octahedra,
                        SliceRule rule, std::vector<bcc::Slice>& slices, Isa isa = bestIsa());

} // namespace vdbtet
