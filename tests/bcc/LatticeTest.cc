/// The lattice tables, derived again from coordinates.
#include "support/Catch.h"

#include "bcc/Lattice.h"

#include <vdbtet/Quality.h>

#include <cmath>
#include <set>

namespace vdbtet::test {

using namespace bcc;
using openvdb::Vec3d;

namespace {

Vec3d at(const Vertex& v) { return Vec3d(v.x, v.y, v.z) + Vec3d(0.5 * v.lattice); }

constexpr Lattice kLattices[] = {A, B};

} // namespace

TEST_CASE("the eight short edges lead to the nearest vertices of the other lattice", "[bcc]") {
    for (Lattice lattice : kLattices) {
        std::set<int> ends;
        for (int d = 0; d < kDirections; ++d) {
            const Step step = shortEdge(lattice, d);
            const Vec3d edge = at({other(lattice), step.x, step.y, step.z}) - at({lattice, 0, 0, 0});
            for (int axis = 0; axis < 3; ++axis) REQUIRE(edge[axis] == 0.5 * sign(d, axis));
            const Step back = shortEdge(other(lattice), opposite(d));
            REQUIRE(step.x + back.x == 0);
            REQUIRE(step.y + back.y == 0);
            REQUIRE(step.z + back.z == 0);
            ends.insert(step.x * 100 + step.y * 10 + step.z);
        }
        REQUIRE(ends.size() == 8);
    }
}

TEST_CASE("an octahedron is a spine with a ring counter-clockwise about it", "[bcc]") {
    for (Lattice lattice : kLattices) {
        for (int axis = 0; axis < 3; ++axis) {
            const Octahedron& o = kOctahedra[lattice][axis];
            Vec3d unit(0.0);
            unit[axis] = 1.0;
            REQUIRE(at(o[1]) - at(o[0]) == unit);
            const Vec3d centre = 0.5 * (at(o[0]) + at(o[1]));
            for (int r = 0; r < 4; ++r) {
                REQUIRE(o[2 + r].lattice == other(lattice));
                const Vec3d p = at(o[2 + r]) - centre, q = at(o[2 + (r + 1) % 4]) - centre;
                REQUIRE(p.dot(unit) == 0.0);
                REQUIRE(p.length() == Approx(std::sqrt(0.5)));
                REQUIRE(p.cross(q).dot(unit) == Approx(0.5));
            }
        }
    }
}

TEST_CASE("every slice fills the octahedron with positive tets", "[bcc]") {
    for (Lattice lattice : kLattices) {
        for (int axis = 0; axis < 3; ++axis) {
            const Octahedron& o = kOctahedra[lattice][axis];
            for (const auto& slice : kSliceTets) {
                double volume = 0.0;
                for (const auto& tet : slice) {
                    const double v =
                        signedVolume6(at(o[tet[0]]), at(o[tet[1]]), at(o[tet[2]]), at(o[tet[3]]));
                    REQUIRE(v > 0.0);
                    volume += v / 6.0;
                }
                REQUIRE(volume == Approx(1.0 / 3.0));
            }
        }
    }
}

TEST_CASE("the first two tets of slices A and B hold v2, the others v1", "[bcc]") {
    for (Slice slice : {SliceA, SliceB}) {
        for (int t = 0; t < 4; ++t) {
            const std::set<int> vertices(kSliceTets[slice][t], kSliceTets[slice][t] + 4);
            REQUIRE(vertices.count(1) == (t < 2 ? 1u : 0u));
            REQUIRE(vertices.count(0) == (t < 2 ? 0u : 1u));
            REQUIRE(vertices.count(slice == SliceA ? 2 : 3) == 1);
            REQUIRE(vertices.count(slice == SliceA ? 4 : 5) == 1);
        }
    }
}

TEST_CASE("the ring edges belong to the tets of slice S", "[bcc]") {
    for (Lattice lattice : kLattices) {
        for (int axis = 0; axis < 3; ++axis) {
            const Octahedron& o = kOctahedra[lattice][axis];
            for (int t = 0; t < 4; ++t) {
                const RingEdge& edge = kRingEdges[t];
                Vec3d upper = at(o[edge.lower]);
                upper[(axis + edge.axisOffset) % 3] += 1.0;
                bool hasLower = false, hasUpper = false;
                for (int v : kSliceTets[S][t]) {
                    hasLower = hasLower || v == edge.lower;
                    hasUpper = hasUpper || at(o[v]) == upper;
                }
                REQUIRE(hasLower);
                REQUIRE(hasUpper);
            }
        }
    }
}

} // namespace vdbtet::test
