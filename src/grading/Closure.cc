/// @file Closure.cc
/// One gather a level, by rows of bits.
#include "grading/Closure.h"

namespace vdbtet {

namespace {

/// Octants of one level in a cube of three tiles an edge, in rows along z.
template <int kDim>
struct Cube {
    std::uint32_t rows[kDim][kDim] = {};
};

/// Keep the even bits, side by side.
std::uint32_t evenBits(std::uint32_t row) {
    row &= 0x55555555;
    row = (row | row >> 1) & 0x33333333;
    row = (row | row >> 2) & 0x0f0f0f0f;
    row = (row | row >> 4) & 0x00ff00ff;
    return (row | row >> 8) & 0x0000ffff;
}

/// @return the next coarser octants, all but the outermost: those with an octant in the block of 4 x 4 x 4
/// around them, the block's 8 corners left out.
template <int kDim>
Cube<kDim / 2> parentsOf(const Cube<kDim>& octants) {
    constexpr int kParents = kDim / 2;
    // By slab along x: the parents' bits, still two apart, that the slab gives to parents of which it is an
    // inner or an outer one.
    std::uint32_t inner[kDim][kParents], outer[kDim][kParents];
    for (int x = 0; x < kDim; ++x) {
        for (int y = 1; y < kParents - 1; ++y) {
            const std::uint32_t* row = octants.rows[x] + 2 * y - 1;
            const auto middleTwo = [&](int i) { return row[i] | row[i] >> 1; };
            const auto allFour = [&](int i) { return row[i] << 1 | row[i] | row[i] >> 1 | row[i] >> 2; };
            const std::uint32_t both = allFour(1) | allFour(2);
            inner[x][y] = both | allFour(0) | allFour(3);
            outer[x][y] = both | middleTwo(0) | middleTwo(3);
        }
    }
    Cube<kParents> parents;
    for (int x = 1; x < kParents - 1; ++x) {
        for (int y = 1; y < kParents - 1; ++y) {
            parents.rows[x][y] =
                evenBits(outer[2 * x - 1][y] | inner[2 * x][y] | inner[2 * x + 1][y] | outer[2 * x + 2][y]);
        }
    }
    return parents;
}

Cube<24> gather(const std::array<const TileMask*, 27>& units) {
    Cube<24> cube;
    for (int slot = 0; slot < 27; ++slot) {
        if (!units[slot]) continue;
        const int firstX = slot / 9 * 8, firstY = slot / 3 % 3 * 8, shift = slot % 3 * 8;
        for (int x = 0; x < 8; ++x) {
            const std::uint64_t word = units[slot]->words[x];
            if (word == 0) continue;
            for (int y = 0; y < 8; ++y)
                cube.rows[firstX + x][firstY + y] |= std::uint32_t(word >> (8 * y) & 0xff) << shift;
        }
    }
    return cube;
}

} // namespace

OctantSet closeOctants(const std::array<const TileMask*, 27>& units) {
    const Cube<12> level1 = parentsOf(gather(units));
    const Cube<6> level2 = parentsOf(level1);
    const Cube<3> level3 = parentsOf(level2);
    OctantSet set;
    for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 4; ++y)
            set.level1 |= std::uint64_t(level1.rows[4 + x][4 + y] >> 4 & 0xf) << (x << 4 | y << 2);
    }
    for (int x = 0; x < 2; ++x) {
        for (int y = 0; y < 2; ++y)
            set.level2 |= std::uint8_t((level2.rows[2 + x][2 + y] >> 2 & 0x3) << (x << 2 | y << 1));
    }
    set.level3 = level3.rows[1][1] >> 1 & 1;
    return set;
}

} // namespace vdbtet
