/// @file Octahedron.h
/// The octahedron of a spine and its three slices (paper, figures 8 and 9, eq. 9).
#pragma once

#include "reference/DenseLattice.h"

namespace vdbtet::test {

/// A spine's octahedron in the frame (e1,e2,e3), a right-handed turn of the lattice axes: v1 and
/// v2 = v1 + e1 are the spine, v3 to v6 the ring, counter-clockwise about e1 from (1,1,-1)/2.
struct Octahedron {
    LatticePoint e1, e2, e3;
    std::array<LatticePoint, 6> v;

    Octahedron(const LatticePoint& v1, const LatticePoint& along, const LatticePoint& across)
        : e1(along), e2(across), e3(along.cross(across)),
          v{v1, v1 + 2 * e1, v1 + e1 + e2 - e3, v1 + e1 + e2 + e3, v1 + e1 - e2 + e3, v1 + e1 - e2 - e3} {}
};

using Slice = std::array<std::array<int, 4>, 4>;

/// The tets of eq. (9), by the paper's vertex numbers.
constexpr Slice kSliceS{{{1, 3, 2, 6}, {1, 4, 2, 3}, {1, 5, 2, 4}, {1, 6, 2, 5}}};
constexpr Slice kSliceA{{{3, 4, 5, 2}, {3, 5, 6, 2}, {3, 5, 4, 1}, {3, 6, 5, 1}}};
constexpr Slice kSliceB{{{6, 3, 4, 2}, {6, 4, 5, 2}, {6, 4, 3, 1}, {6, 5, 4, 1}}};

} // namespace vdbtet::test
