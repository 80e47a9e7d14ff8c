/// @file GradientRoot.h
/// The way from a lattice vertex to the surface along the gradient of the field.
#pragma once

#include "bcc/Lattice.h"
#include "field/Root.h"

#include <openvdb/Types.h>

#include <cmath>

namespace vdbtet {

/// @return the gradient of the field at a vertex, by lattice units, from its values at the far ends of the
/// eight short edges: half the sum of the edges, each times its value. Exact where the field is linear.
inline openvdb::Vec3d gradientEstimate(const double (&around)[bcc::kDirections]) {
    openvdb::Vec3d gradient(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const int far = 4 >> axis; // of the direction's number
        double sum = 0.0;
        for (int d = 0; d < bcc::kDirections; ++d) {
            if (d & far) sum += around[d] - around[d ^ far];
        }
        gradient[axis] = 0.25 * sum;
    }
    return gradient;
}

/// @return the way from a vertex to where the field is zero, down the gradient from inside, up from outside,
/// in lattice units; zero where the field does not change its sign within @a reach.
/// @param near    the field at the vertex
/// @param around  the field at the far ends of its short edges
/// @param phi     the field at some offset from the vertex
template <typename Function>
openvdb::Vec3d rootAlongGradient(double near, const double (&around)[bcc::kDirections], double reach,
                                 Function&& phi) {
    const openvdb::Vec3d gradient = gradientEstimate(around);
    const double length = gradient.length();
    if (!(length > 0.0)) return openvdb::Vec3d(0.0);
    const openvdb::Vec3d way = gradient * ((near >= 0.0 ? -reach : reach) / length);
    const double far = phi(way);
    if ((near >= 0.0) == (far >= 0.0)) return openvdb::Vec3d(0.0);
    // Where the field is linear the first guess is right, but for rounding.
    const double zero = 1e-13 * std::abs(far - near);
    return way * rootInUnitInterval(near, far, [&](double s) {
               const double value = phi(way * s);
               return std::abs(value) > zero ? value : 0.0;
           });
}

} // namespace vdbtet
