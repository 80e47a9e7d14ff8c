/// Ranks, shifts and padding of tile masks against one bit at a time.
#include "support/Catch.h"
#include "support/Fixtures.h"

#include "bits/PaddedMask.h"

#include <vector>

namespace vdbtet::test {

namespace {

std::vector<TileMask> randomMasks(std::uint64_t seed) {
    Random random(seed);
    std::vector<TileMask> masks(27);
    for (TileMask& mask : masks) {
        for (auto& word : mask.words) word = random.next();
    }
    return masks;
}

MasksAround around(const std::vector<TileMask>& masks) {
    MasksAround result;
    for (int slot = 0; slot < 27; ++slot) result.masks[slot] = &masks[slot];
    return result;
}

/// Bit (x,y,z) of the whole, each coordinate in -8..15.
bool bitAt(const std::vector<TileMask>& masks, int x, int y, int z) {
    return masks[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))].test(
        TileMask::bit(x & 7, y & 7, z & 7));
}

} // namespace

TEST_CASE("a rank counts the set bits below", "[bits]") {
    const TileMask mask = randomMasks(1)[0];
    int below = 0;
    for (int n = 0; n < TileMask::kSize; ++n) {
        REQUIRE(mask.rank(n) == below);
        below += mask.test(n);
    }
    REQUIRE(mask.count() == below);
}

TEST_CASE("forEach visits the set bits in ascending order", "[bits]") {
    const TileMask mask = randomMasks(2)[0];
    std::vector<int> expected, visited;
    for (int n = 0; n < TileMask::kSize; ++n) {
        if (mask.test(n)) expected.push_back(n);
    }
    mask.forEach([&](int n) { visited.push_back(n); });
    REQUIRE(visited == expected);
}

TEST_CASE("a shifted mask reads the neighbours' bits", "[bits]") {
    const auto masks = randomMasks(3);
    const PaddedMask padded(around(masks));
    for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dz = -1; dz <= 1; ++dz) {
                const TileMask shifted = padded.shifted(dx, dy, dz);
                for (int n = 0; n < TileMask::kSize; ++n) {
                    const int x = n >> 6, y = n >> 3 & 7, z = n & 7;
                    if (shifted.test(n) == bitAt(masks, x + dx, y + dy, z + dz)) continue;
                    FAIL("step " << dx << ' ' << dy << ' ' << dz << " bit " << x << ' ' << y << ' ' << z);
                }
            }
        }
    }
}

TEST_CASE("a padded mask has the tile and one bit of each neighbour", "[bits]") {
    const auto masks = randomMasks(4);
    const PaddedMask padded(around(masks));
    std::vector<int> expected, visited;
    for (int x = -1; x <= 8; ++x) {
        for (int y = -1; y <= 8; ++y) {
            for (int z = -1; z <= 8; ++z) {
                const int n = PaddedMask::bit(x, y, z);
                REQUIRE(PaddedMask::x(n) == x);
                REQUIRE(PaddedMask::y(n) == y);
                REQUIRE(PaddedMask::z(n) == z);
                REQUIRE(padded.test(n) == bitAt(masks, x, y, z));
                if (padded.test(n)) expected.push_back(n);
            }
        }
    }
    padded.forEach([&](int n) { visited.push_back(n); });
    REQUIRE(visited == expected);
    REQUIRE(padded.count() == int(expected.size()));
}

TEST_CASE("a filled core is the tile without its border", "[bits]") {
    const PaddedMask core = PaddedMask::filledCore();
    REQUIRE(core.count() == TileMask::kSize);
    REQUIRE(core.core() == TileMask::filled(true));
}

TEST_CASE("a padded mask moves down along each axis", "[bits]") {
    const PaddedMask padded(around(randomMasks(5)));
    for (int axis = 0; axis < 3; ++axis) {
        const int step = PaddedMask::step(axis == 0, axis == 1, axis == 2);
        const PaddedMask moved = padded.movedDown(step);
        for (int n = 0; n < TileMask::kSize; ++n)
            REQUIRE(moved.test(PaddedMask::bit(n)) == padded.test(PaddedMask::bit(n) + step));
    }
}

} // namespace vdbtet::test
