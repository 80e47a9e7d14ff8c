/// The runs of tiles and who is whose neighbour, against a plain set of tiles.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include <vdbtet/Errors.h>

#include <map>

namespace vdbtet::test {

using openvdb::Coord;

TEST_CASE("runs of interior tiles fill what the surface encloses", "[tiles]") {
    const auto grid = levelSet(sphere(Vec3d(3.0, 2.0, 1.0), 40.0));
    const Stages stages(*grid);
    const Layout& layout = stages.layout;
    std::map<Coord, std::int64_t> spanOf;
    std::int64_t interior = 0;
    for (std::int64_t s = 0; s < layout.spans.size(); ++s) {
        const Span& span = layout.spans[s];
        for (int z = 0; z < span.count; ++z) {
            const Coord tile = span.first.offsetBy(0, 0, z);
            REQUIRE(spanOf.emplace(tile, s).second);
            if (span.tile >= 0) {
                REQUIRE(layout.surfaceTiles[span.tile] == tile);
                continue;
            }
            ++interior;
            const TileSigns signs = signsOf(*stages.field.sampler(), tile);
            REQUIRE(signs[bcc::A].full());
            REQUIRE(signs[bcc::B].full());
        }
    }
    REQUIRE(interior > 100);
    for (const auto& entry : spanOf) {
        const auto around = layout.spans.around(entry.first);
        for (int slot = 0; slot < 27; ++slot) {
            const auto found =
                spanOf.find(entry.first.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1));
            const std::int64_t span = found == spanOf.end() ? -1 : found->second;
            REQUIRE(around[slot] == span);
            const TileRef surface = layout.spans[entry.second].tile;
            if (surface < 0) continue;
            REQUIRE(layout.neighbours[surface][slot] == (span < 0 ? kOutside : layout.spans[span].tile));
        }
    }
}

TEST_CASE("a column that starts inside is refused", "[tiles]") {
    std::vector<TileSigns> signs(1);
    signs[0].fill(TileMask::filled(true));
    Interrupt interrupt(nullptr);
    REQUIRE_THROWS_AS(makeLayout({Coord(0)}, signs, interrupt), UnboundedInside);
}

TEST_CASE("a column that ends inside is refused", "[tiles]") {
    std::vector<TileSigns> signs(1);
    signs[0][bcc::A].set(TileMask::bit(0, 0, 7));
    Interrupt interrupt(nullptr);
    REQUIRE_THROWS_AS(makeLayout({Coord(0)}, signs, interrupt), UnboundedInside);
}

} // namespace vdbtet::test
