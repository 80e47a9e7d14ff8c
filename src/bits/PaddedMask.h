/// @file PaddedMask.h
/// The bits of a tile and of a border of one vertex around it, in rows along z.
///
/// Masks of neighbouring vertices are shifts of it, a slab at a time; and a bit's number is the vertex's
/// local number, by which the stages that look around a tile index all they unpack.
#pragma once

#include "bits/TileMask.h"

#include <cstring>

namespace vdbtet {

class PaddedMask {
public:
    static constexpr int kDim = TileMask::kDim + 2;
    static constexpr int kRowBits = 16; ///< of which kDim are used: a row is a word
    static constexpr int kSlabBits = kDim * kRowBits;
    static constexpr int kSize = kDim * kSlabBits;
    static constexpr int kRows = kDim * kDim;
    static constexpr std::uint16_t kRow = (1 << kDim) - 1; ///< all bits of a row

    /// @return the number of the bit at (x,y,z), each in -1..8; numbers of neighbours differ by bit(dx,dy,dz)
    /// - bit(0,0,0) wherever they lie.
    static constexpr int bit(int x, int y, int z) {
        return (x + 1) * kSlabBits + (y + 1) * kRowBits + (z + 1);
    }
    static constexpr int step(int dx, int dy, int dz) { return dx * kSlabBits + dy * kRowBits + dz; }
    /// @return the number here of bit @a n of a TileMask.
    static constexpr int bit(int n) { return bit(n >> 6, n >> 3 & 7, n & 7); }

    static constexpr int x(int n) { return int(unsigned(n) / kSlabBits) - 1; }
    static constexpr int y(int n) { return int(unsigned(n) / kRowBits % kDim) - 1; }
    static constexpr int z(int n) { return int(unsigned(n) % kRowBits) - 1; }

    PaddedMask() = default;
    explicit PaddedMask(const MasksAround& around);
    /// @return the mask of all bits.
    static PaddedMask filled() {
        PaddedMask mask;
        for (std::uint16_t& row : mask.rows) row = kRow;
        return mask;
    }
    /// @return the mask of all bits of the tile itself.
    static PaddedMask filledCore() {
        PaddedMask mask;
        for (int x = 0; x < TileMask::kDim; ++x) {
            for (int y = 0; y < TileMask::kDim; ++y) mask.rows[bit(x, y, 0) / kRowBits] = 0xff << 1;
        }
        return mask;
    }

    bool test(int n) const { return rows[n >> 4] >> (n & 15) & 1; }
    void set(int n, bool on = true) { rows[n >> 4] |= std::uint16_t(unsigned(on) << (n & 15)); }
    void remove(int n) { rows[n >> 4] &= std::uint16_t(~(1u << (n & 15))); }
    void remove(const PaddedMask& other) {
        for (int r = 0; r < kRows; ++r) rows[r] &= std::uint16_t(~other.rows[r]);
    }
    void add(const PaddedMask& other) {
        for (int r = 0; r < kRows; ++r) rows[r] |= other.rows[r];
    }

    /// @return the mask whose bit (x,y,z) is bit (x+dx, y+dy, z+dz); each step in -1..1.
    TileMask shifted(int dx, int dy, int dz) const {
        TileMask result;
        for (int x = 0; x < TileMask::kDim; ++x) {
            Rows slab;
            std::memcpy(&slab, rows + (x + 1 + dx) * kDim + 1 + dy, sizeof slab);
            result.words[x] = word((slab >> (1 + dz)) & 0xff);
        }
        return result;
    }
    void intersect(const PaddedMask& other) {
        for (int r = 0; r < kRows; ++r) rows[r] &= other.rows[r];
    }

    /// @return the mask whose bit n is bit n + @a step of this one, the step being one up along an axis; bits
    /// at the far border are arbitrary.
    PaddedMask movedDown(int step) const {
        PaddedMask result;
        const int skipped = step / kRowBits, shift = step % kRowBits;
        for (int r = 0; r < kRows - skipped; ++r) result.rows[r] = std::uint16_t(rows[r + skipped] >> shift);
        return result;
    }

    /// @return the same the other way: its bit n + @a step is bit n of this one, if that is in its row and
    /// slab.
    PaddedMask movedUp(int step) const {
        PaddedMask result;
        const int skipped = step / kRowBits, shift = step % kRowBits;
        for (int r = skipped; r < kRows; ++r) result.rows[r] = std::uint16_t(rows[r - skipped] << shift);
        return result;
    }

    /// @return the bits of the tile itself.
    TileMask core() const { return shifted(0, 0, 0); }

    bool any() const {
        unsigned all = 0;
        for (const std::uint16_t row : rows) all |= row;
        return all != 0;
    }
    int count() const {
        int sum = 0;
        for (std::uint64_t word : words()) sum += countBits(word);
        return sum;
    }

    /// Call @a visit(n) for each set bit, in ascending order.
    template <typename Visit>
    void forEach(Visit&& visit) const {
        forEachBit(words(), visit);
    }

    std::uint16_t rows[kRows] = {}; ///< x-major

private:
    static constexpr int kWords = kRows / 4;
    static_assert(4 * kWords == kRows && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
                  "four rows make a word, the first the lowest");
    std::array<std::uint64_t, kWords> words() const {
        std::array<std::uint64_t, kWords> words;
        std::memcpy(words.data(), rows, sizeof rows);
        return words;
    }

    // Eight rows of a slab at a time, in vectors as both GCC and Clang know them: a byte of a tile's word is
    // a row.
    typedef std::uint16_t Rows __attribute__((vector_size(16)));
    typedef std::uint8_t Bytes __attribute__((vector_size(8)));

    static Rows widened(std::uint64_t word) {
        Bytes bytes;
        std::memcpy(&bytes, &word, sizeof bytes);
        return __builtin_convertvector(bytes, Rows);
    }
    static std::uint64_t word(Rows rows) {
        const Bytes bytes = __builtin_convertvector(rows, Bytes);
        std::uint64_t word;
        std::memcpy(&word, &bytes, sizeof word);
        return word;
    }
};

inline PaddedMask::PaddedMask(const MasksAround& around) {
    for (int x = -1; x <= TileMask::kDim; ++x) {
        std::uint64_t words[3][3]; // by the y and z steps to the tile
        for (int y = 0; y < 3; ++y) {
            for (int z = 0; z < 3; ++z)
                words[y][z] = around.masks[neighbourSlot(tileStep(x), y - 1, z - 1)]->words[x & 7];
        }
        std::uint16_t* slab = rows + (x + 1) * kDim;
        const Rows inner =
            (widened(words[1][1]) << 1) | (widened(words[1][0]) >> 7) | ((widened(words[1][2]) & 1) << 9);
        std::memcpy(slab + 1, &inner, sizeof inner);
        const auto row = [&](const std::uint64_t(&w)[3], int shift) {
            return std::uint16_t((w[1] >> shift & 0xff) << 1 | (w[0] >> shift & 0xff) >> 7 |
                                 (w[2] >> shift & 1) << 9);
        };
        slab[0] = row(words[0], 56);
        slab[kDim - 1] = row(words[2], 0);
    }
}

} // namespace vdbtet
