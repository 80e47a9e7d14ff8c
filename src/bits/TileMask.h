/// @file TileMask.h
/// One bit for each of the 8 x 8 x 8 vertices of a tile, and such masks of neighbouring tiles.
///
/// A bit's number is x<<6 | y<<3 | z, as in a VDB leaf: a word is an x-slab, a byte a z-row.
#pragma once

#include <array>
#include <cstdint>

namespace vdbtet {

inline int countBits(std::uint64_t word) { return __builtin_popcountll(word); }
inline int lowestBit(std::uint64_t word) { return __builtin_ctzll(word); }

struct TileMask {
    static constexpr int kDim = 8;
    static constexpr int kSize = kDim * kDim * kDim;

    std::array<std::uint64_t, kDim> words{};

    static constexpr int bit(int x, int y, int z) { return x << 6 | y << 3 | z; }
    static TileMask filled(bool on) {
        TileMask mask;
        mask.words.fill(on ? ~std::uint64_t(0) : 0);
        return mask;
    }

    bool test(int n) const { return words[n >> 6] >> (n & 63) & 1; }
    void set(int n) { words[n >> 6] |= std::uint64_t(1) << (n & 63); }
    void reset(int n) { words[n >> 6] &= ~(std::uint64_t(1) << (n & 63)); }

    bool any() const {
        std::uint64_t all = 0;
        for (auto word : words) all |= word;
        return all != 0;
    }
    bool full() const {
        std::uint64_t all = ~std::uint64_t(0);
        for (auto word : words) all &= word;
        return ~all == 0;
    }
    int count() const {
        int sum = 0;
        for (auto word : words) sum += countBits(word);
        return sum;
    }
    /// @return how many bits below bit @a n are set.
    int rank(int n) const {
        int sum = 0;
        for (int w = 0; w < n >> 6; ++w) sum += countBits(words[w]);
        return sum + countBits(words[n >> 6] & ((std::uint64_t(1) << (n & 63)) - 1));
    }

    /// Call @a visit(n) for each set bit, in ascending order.
    template <typename Visit>
    void forEach(Visit&& visit) const {
        for (int w = 0; w < kDim; ++w) {
            for (std::uint64_t word = words[w]; word != 0; word &= word - 1) visit(w << 6 | lowestBit(word));
        }
    }

    TileMask& operator&=(const TileMask& o) {
        for (int w = 0; w < kDim; ++w) words[w] &= o.words[w];
        return *this;
    }
    TileMask& operator|=(const TileMask& o) {
        for (int w = 0; w < kDim; ++w) words[w] |= o.words[w];
        return *this;
    }
    TileMask& operator^=(const TileMask& o) {
        for (int w = 0; w < kDim; ++w) words[w] ^= o.words[w];
        return *this;
    }
    friend TileMask operator&(TileMask a, const TileMask& b) { return a &= b; }
    friend TileMask operator|(TileMask a, const TileMask& b) { return a |= b; }
    friend TileMask operator^(TileMask a, const TileMask& b) { return a ^= b; }
    friend TileMask operator~(TileMask a) {
        for (auto& word : a.words) word = ~word;
        return a;
    }
    friend bool operator==(const TileMask& a, const TileMask& b) { return a.words == b.words; }
    friend bool operator!=(const TileMask& a, const TileMask& b) { return !(a == b); }
};

/// @return the number from 0 to 26 of the neighbour tile in direction (dx,dy,dz), each in -1..1; 13 is the
/// tile itself.
constexpr int neighbourSlot(int dx, int dy, int dz) { return (dx + 1) * 9 + (dy + 1) * 3 + (dz + 1); }

/// The tile step (-1, 0 or 1) to the tile that holds local coordinate @a x in -8..15.
constexpr int tileStep(int x) { return x < 0 ? -1 : x > 7 ? 1 : 0; }

/// The masks of a tile and of its 26 neighbours, seen as one mask with coordinates -8 to 15.
struct MasksAround {
    std::array<const TileMask*, 27> masks; ///< by neighbourSlot()

    /// @return the mask whose bit (x,y,z) is bit (x+dx, y+dy, z+dz) of the whole; each step in -1..1.
    TileMask shifted(int dx, int dy, int dz) const {
        TileMask result;
        for (int x = 0; x < TileMask::kDim; ++x) {
            const std::uint64_t rows = shiftedRows(x + dx, 0, dz);
            result.words[x] = dy == 0  ? rows
                              : dy > 0 ? rows >> 8 | shiftedRows(x + dx, 1, dz) << 56
                                       : rows << 8 | shiftedRows(x + dx, -1, dz) >> 56;
        }
        return result;
    }

    /// @return the bits -1 to 8 of the z-row at (@a x, @a y), each in -1..8; the lowest bit is z = -1.
    unsigned row(int x, int y) const {
        const int slot = neighbourSlot(tileStep(x), tileStep(y), 0);
        const auto bits = [&](int dz) {
            return unsigned(masks[slot + dz]->words[x & 7] >> ((y & 7) * 8) & 0xff);
        };
        return bits(-1) >> 7 | bits(0) << 1 | (bits(1) & 1) << 9;
    }

private:
    /// The slab @a x of the tiles at @a tileY, moved by @a dz along its rows.
    std::uint64_t shiftedRows(int x, int tileY, int dz) const {
        constexpr std::uint64_t kLow = 0x0101010101010101, kHigh = 0x8080808080808080;
        const int slot = neighbourSlot(tileStep(x), tileY, 0);
        const auto slab = [&](int tileZ) { return masks[slot + tileZ]->words[x & 7]; };
        return dz == 0  ? slab(0)
               : dz > 0 ? (slab(0) & ~kLow) >> 1 | (slab(1) & kLow) << 7
                        : (slab(0) & ~kHigh) << 1 | (slab(-1) & kHigh) >> 7;
    }
};

} // namespace vdbtet
