/// @file TileMask.h
/// One bit for each of the 8 x 8 x 8 vertices of a tile, and the masks of neighbouring tiles.
///
/// A bit's number is x<<6 | y<<3 | z, as in a VDB leaf: a word is an x-slab, a byte a z-row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vdbtet {

inline int countBits(std::uint64_t word) { return __builtin_popcountll(word); }
inline int lowestBit(std::uint64_t word) { return __builtin_ctzll(word); }

/// @brief Call @a visit(n) for each set bit of some words, in ascending order.
/// @details A loop over the bits of each word would guess its end wrong nearly every time: most words have
/// none, one or two. Here they are listed first, two from each word whatever it has.
template <std::size_t kWords, typename Visit>
void forEachBit(const std::array<std::uint64_t, kWords>& words, Visit&& visit) {
    constexpr std::uint64_t kTop = std::uint64_t(1) << 63; // keeps the lowest bit of nothing defined
    std::uint16_t list[kWords * 64 + 2];
    std::uint16_t* next = list;
    for (std::size_t w = 0; w < kWords; ++w) {
        std::uint64_t word = words[w];
        std::uint16_t* const end = next + countBits(word);
        next[0] = std::uint16_t(w << 6 | unsigned(lowestBit(word | kTop)));
        word &= word - 1;
        next[1] = std::uint16_t(w << 6 | unsigned(lowestBit(word | kTop)));
        word &= word - 1;
        for (next += 2; next < end; ++next, word &= word - 1)
            *next = std::uint16_t(w << 6 | unsigned(lowestBit(word)));
        next = end;
    }
    for (const std::uint16_t* n = list; n != next; ++n) visit(int(*n));
}

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
        const std::uint64_t below = (std::uint64_t(1) << (n & 63)) - 1;
        int sum = 0;
        for (int w = 0; w < kDim; ++w) { // the same steps for all n, so none is guessed wrong
            const std::uint64_t part = w < n >> 6 ? ~std::uint64_t(0) : w == n >> 6 ? below : 0;
            sum += countBits(words[w] & part);
        }
        return sum;
    }

    /// Call @a visit(n) for each set bit, in ascending order.
    template <typename Visit>
    void forEach(Visit&& visit) const {
        forEachBit(words, visit);
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
constexpr int tileStep(int x) { return (x > 7) - (x < 0); }

/// The masks of a tile and of its 26 neighbours.
struct MasksAround {
    std::array<const TileMask*, 27> masks; ///< by neighbourSlot()
};

} // namespace vdbtet
