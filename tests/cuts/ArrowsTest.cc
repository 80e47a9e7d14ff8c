/// What is known of a mesh from signs and cut edges.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

namespace vdbtet::test {

namespace {

bool isInside(const openvdb::FloatGrid& grid, const bcc::Vertex& v) {
    const auto values = grid.getConstAccessor();
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const int far = v.lattice == bcc::A ? 0 : corner;
        sum += values.getValue(openvdb::Coord(v.x + (far >> 2), v.y + (far >> 1 & 1), v.z + (far & 1)));
    }
    return sum <= 0.0;
}

} // namespace

TEST_CASE("tets of inside vertices alone are counted, and counting ends at the most") {
    const auto grid = levelSet(sphere({3.0, 4.0, 5.0}, 9.3));
    const Stages stages(*grid);
    std::int64_t expected = 0;
    for (const openvdb::Coord& tile : stages.tiles) {
        for (int n = 0; n < TileMask::kSize; ++n) {
            for (const bcc::Octahedron& octahedron : bcc::kOctahedra[bcc::A]) {
                bool inside = true;
                for (const bcc::Vertex& v : octahedron) {
                    inside = inside && isInside(*grid, {v.lattice, 8 * tile.x() + (n >> 6) + v.x,
                                                        8 * tile.y() + (n >> 3 & 7) + v.y,
                                                        8 * tile.z() + (n & 7) + v.z});
                }
                expected += inside ? 4 : 0;
            }
        }
    }
    REQUIRE(expected > 10000);
    CHECK(stages.cuts.insideTets == expected);

    Interrupt interrupt(nullptr);
    CHECK(findCuts(stages.field, stages.tiles, 0.5, interrupt, expected).insideTets == expected);
    const Cuts part = findCuts(stages.field, stages.tiles, 0.5, interrupt, 0);
    CHECK(part.insideTets > 0);
}

} // namespace vdbtet::test
