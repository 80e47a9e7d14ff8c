/// @file Suspects.cc
/// By masks, for rows of vertices at a time.
#include "flips/Suspects.h"

#include <cstdint>
#include <cstring>

namespace vdbtet {

namespace {

using Row = std::uint16_t;
constexpr int kDim = PaddedMask::kDim;
constexpr int kFirst = kDim + 1; ///< the row of a tile's first vertex

/// The rows of a tile's masks, by lattice, and room for a whole number of the widest vectors, and what they
/// look at.
constexpr int kLooked = 96, kRoom = 128;
static_assert(kFirst + kLooked + kFirst <= kRoom && kFirst + kLooked >= PaddedMask::kRows - kFirst);
using Rows = Row[2][kRoom];

/// Which neighbours of a row of vertices are in some set: bits are the vertices.
struct Around {
    /// The ends of short edges, below and above along z, at (-x,-y), (-x,+y), (+x,-y), (+x,+y): the corners
    /// of a cube.
    Row low[4], high[4];
    /// The ends of long edges, at -x, +x, -y, +y, -z, +z: beyond the cube's faces.
    Row face[6];
};

/// @param r  the row
template <bcc::Lattice lattice>
VDBTET_KERNEL inline Around lookAround(const Rows& set, int r) {
    constexpr int kLowest = lattice == bcc::A ? -kDim - 1 : 0;
    constexpr int kColumns[4] = {kLowest, kLowest + 1, kLowest + kDim, kLowest + kDim + 1};
    const Row* same = set[lattice] + r;
    const Row* other = set[bcc::other(lattice)] + r;
    Around around;
    for (int k = 0; k < 4; ++k) {
        const Row column = other[kColumns[k]];
        around.low[k] = lattice == bcc::A ? Row(column + column) : column;
        around.high[k] = lattice == bcc::A ? column : Row(column >> 1);
    }
    around.face[0] = same[-kDim];
    around.face[1] = same[kDim];
    around.face[2] = same[-1];
    around.face[3] = same[1];
    around.face[4] = Row(same[0] + same[0]);
    around.face[5] = Row(same[0] >> 1);
    return around;
}

/// @return where the neighbours in the set are surely connected, or none.
VDBTET_KERNEL inline Row connected(const Around& in) {
    const Row *low = in.low, *high = in.high, *face = in.face;
    const auto column = [&](int k) VDBTET_KERNEL { return Row(low[k] | high[k]); };
    // Whether the column has some, and none that are joined to one of the column before it, about the cube.
    const auto first = [&](int k, int before) VDBTET_KERNEL {
        return Row(column(k) & ~((low[k] & low[before]) | (high[k] & high[before])));
    };
    const Row a = first(0, 2), b = first(1, 0), c = first(3, 1), d = first(2, 3);
    const Row one = Row((a ^ b ^ c ^ d) & ~((a & b) | (c & d)));
    const Row ring = Row((low[0] & low[1] & low[2] & low[3]) | (high[0] & high[1] & high[2] & high[3]));
    const Row left = Row(column(0) | column(1)), right = Row(column(2) | column(3)),
              front = Row(column(0) | column(2)), back = Row(column(1) | column(3)),
              below = Row(low[0] | low[1] | low[2] | low[3]),
              above = Row(high[0] | high[1] | high[2] | high[3]);
    // Beyond a face of which no corner is in the set.
    const Row alone = Row((face[0] & ~left) | (face[1] & ~right) | (face[2] & ~front) | (face[3] & ~back) |
                          (face[4] & ~below) | (face[5] & ~above));
    return Row((one | ring | ~(left | right)) & ~alone);
}

/// @return where three of the set are a triangle of the link: beyond a face, and at two corners of it that
/// are not across from each other.
VDBTET_KERNEL inline Row withTriangle(const Around& in) {
    const Row *low = in.low, *high = in.high, *face = in.face;
    const auto beyond = [&](int k, int l) VDBTET_KERNEL { // the columns k and l
        return Row((low[k] | high[l]) & (high[k] | low[l]));
    };
    const auto along = [](const Row* end)
                           VDBTET_KERNEL { return Row((end[0] | end[3]) & (end[1] | end[2])); };
    return Row((face[0] & beyond(0, 1)) | (face[1] & beyond(2, 3)) | (face[2] & beyond(0, 2)) |
               (face[3] & beyond(1, 3)) | (face[4] & along(low)) | (face[5] & along(high)));
}

template <bcc::Lattice lattice>
VDBTET_KERNEL inline void findRows(const Rows& interior, const Rows& manifold, const Rows& outside,
                                   Row* __restrict suspects) {
    for (int i = 0; i < kLooked; ++i) {
        const int r = kFirst + i;
        const Row clear =
            Row(connected(lookAround<lattice>(interior, r)) & connected(lookAround<lattice>(outside, r)) &
                ~withTriangle(lookAround<lattice>(manifold, r)));
        suspects[i] = Row(manifold[lattice][r] & ~clear);
    }
}

} // namespace

std::array<TileMask, 2> findSuspects(const LocalStates& states, Isa isa) {
    alignas(64) Rows interior, manifold, outside;
    alignas(64) Row found[2][kLooked];
    runOn(isa, [&]() VDBTET_KERNEL {
        for (int lattice = 0; lattice < 2; ++lattice) {
            std::memcpy(interior[lattice], states.interiorMask(lattice).rows, sizeof PaddedMask::rows);
            std::memcpy(manifold[lattice], states.manifoldMask(lattice).rows, sizeof PaddedMask::rows);
            for (int r = PaddedMask::kRows; r < kRoom; ++r) interior[lattice][r] = manifold[lattice][r] = 0;
            for (int r = 0; r < kRoom; ++r)
                outside[lattice][r] = Row(~(interior[lattice][r] | manifold[lattice][r]));
        }
        findRows<bcc::A>(interior, manifold, outside, found[bcc::A]);
        findRows<bcc::B>(interior, manifold, outside, found[bcc::B]);
    });
    std::array<TileMask, 2> suspects;
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        PaddedMask mask;
        std::memcpy(mask.rows + kFirst, found[lattice], sizeof mask.rows - 2 * kFirst * sizeof(Row));
        suspects[lattice] = mask.core();
    }
    return suspects;
}

std::vector<Suspects> findSuspects(const Vertices& vertices, Interrupt& interrupt) {
    std::vector<std::vector<TileMask>> found(std::size_t(vertices.layout.ownCount()));
    parallelRanges(std::int64_t(found.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        LocalStates states;
        for (std::int64_t t = begin; t < end; ++t) {
            if (!vertices.destinations.any(TileRef(t))) continue;
            states.load(vertices, TileRef(t));
            const auto suspects = findSuspects(states);
            if (suspects[bcc::A].any() || suspects[bcc::B].any())
                found[std::size_t(t)].assign(suspects.begin(), suspects.end());
        }
    });
    std::vector<Suspects> all;
    for (std::size_t t = 0; t < found.size(); ++t) {
        if (!found[t].empty()) all.push_back({TileRef(t), {found[t][0], found[t][1]}});
    }
    return all;
}

} // namespace vdbtet
