/// @file Arrows.cc
/// Signs and cut edges by mask, and the packed sets of directions (paper, sections 2.3 and 4.1).
#include "cuts/Arrows.h"

#include <numeric>

namespace vdbtet {

namespace {

/// @return the vertices of @a lattice whose short edge in each direction is cut.
EdgeMasks cutEdgesOf(const std::vector<TileSigns>& signs, TileRef tile, const Neighbours& neighbours,
                     bcc::Lattice lattice) {
    const MasksAround inside = Surroundings(neighbours).signs(signs, bcc::other(lattice));
    EdgeMasks cut;
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(lattice, d);
        cut[d] = signs[tile][lattice] ^ inside.shifted(step.x, step.y, step.z);
    }
    return cut;
}

int count(const EdgeMasks& masks) {
    int sum = 0;
    for (const TileMask& mask : masks) sum += mask.count();
    return sum;
}

/// @return the vertices with a cut edge in any direction.
TileMask endsOf(const EdgeMasks& cut) {
    TileMask ends;
    for (const TileMask& mask : cut) ends |= mask;
    return ends;
}

/// The arrows that leave L_A vertices, for the tiles that have such vertices with cut edges.
class NearerToA {
public:
    NearerToA(const Field& field, const Layout& layout, const std::vector<TileSigns>& signs,
              const std::vector<std::int32_t>& cutEdges, Interrupt& interrupt)
        : mRecord(layout.surfaceCount(), -1) {
        std::vector<TileRef> recorded;
        for (std::int64_t t = 0; t < layout.surfaceCount(); ++t) {
            if (cutEdges[t] == 0) continue;
            mRecord[t] = std::int32_t(recorded.size());
            recorded.push_back(TileRef(t));
        }
        mMasks.resize(recorded.size());
        parallelRanges(std::int64_t(recorded.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
            const auto sampler = field.sampler();
            for (std::int64_t r = begin; r < end; ++r) {
                const TileRef t = recorded[r];
                const EdgeMasks cut = cutEdgesOf(signs, t, layout.neighbours(t), bcc::A);
                mMasks[r] = sampler->nearerToA(layout.surfaceTiles[t], cut);
            }
        });
    }

    const EdgeMasks& operator[](TileRef tile) const {
        return tile >= 0 && mRecord[tile] >= 0 ? mMasks[mRecord[tile]] : mNone;
    }

private:
    EdgeMasks mNone{};
    std::vector<std::int32_t> mRecord; ///< of each surface tile, in mMasks, or -1
    std::vector<EdgeMasks> mMasks;
};

/// @return the L_B vertices with cut edges less those that @a nearer gives to the L_A end.
EdgeMasks nearerToB(EdgeMasks cut, const NearerToA& nearer, const Neighbours& neighbours) {
    for (int d = 0; d < bcc::kDirections; ++d) {
        if (!cut[d].any()) continue;
        // From its L_A end the edge runs the opposite way.
        MasksAround around;
        for (int slot = 0; slot < 27; ++slot)
            around.masks[slot] = &nearer[neighbours[slot]][bcc::opposite(d)];
        const bcc::Step step = bcc::shortEdge(bcc::B, d);
        cut[d] &= ~around.shifted(step.x, step.y, step.z);
    }
    return cut;
}

/// Write for each vertex of @a ends the set of directions in whose mask it is.
void pack(const EdgeMasks& masks, const TileMask& ends, std::uint8_t* sets) {
    ends.forEach([&](int vertex) {
        unsigned set = 0;
        for (int d = 0; d < bcc::kDirections; ++d) set |= unsigned(masks[d].test(vertex)) << d;
        *sets++ = std::uint8_t(set);
    });
}

EdgeMasks unpack(const TileMask& ends, const std::uint8_t* sets) {
    EdgeMasks masks{};
    ends.forEach([&](int vertex) {
        for (unsigned set = *sets++; set != 0; set &= set - 1) masks[lowestBit(set)].set(vertex);
    });
    return masks;
}

} // namespace

std::vector<TileSigns> findSigns(const Field& field, const std::vector<openvdb::Coord>& tiles,
                                 Interrupt& interrupt) {
    std::vector<TileSigns> signs(tiles.size());
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        const auto sampler = field.sampler();
        for (std::int64_t t = begin; t < end; ++t) signs[t] = sampler->signs(tiles[t]);
    });
    return signs;
}

VertexRef farEnd(const Neighbours& neighbours, const VertexRef& v, int direction) {
    const bcc::Step step = bcc::shortEdge(v.lattice, direction);
    const int x = (v.vertex >> 6) + step.x, y = (v.vertex >> 3 & 7) + step.y, z = (v.vertex & 7) + step.z;
    const TileRef tile = neighbours[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    return {tile, bcc::other(v.lattice), TileMask::bit(x & 7, y & 7, z & 7)};
}

Arrows::Arrows(const Field& field, const Layout& layout, const std::vector<TileSigns>& signs,
               Interrupt& interrupt)
    : mSigns(signs), mFirst(layout.surfaceCount()) {
    const std::int64_t tiles = layout.surfaceCount();
    std::vector<std::int32_t> cutEdges(tiles);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const Neighbours neighbours = layout.neighbours(TileRef(t));
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                const EdgeMasks cut = cutEdgesOf(signs, TileRef(t), neighbours, lattice);
                if (lattice == bcc::A) cutEdges[t] = count(cut);
                mFirst[t][lattice] = endsOf(cut).count();
            }
        }
    });
    std::int64_t sum = 0;
    for (auto& tile : mFirst) {
        for (std::int64_t& first : tile) {
            const std::int64_t vertices = first;
            first = sum;
            sum += vertices;
        }
    }
    mCutEdges = std::accumulate(cutEdges.begin(), cutEdges.end(), std::int64_t(0));

    const NearerToA nearer(field, layout, signs, cutEdges, interrupt);
    mLeaving.resize(sum);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const Neighbours neighbours = layout.neighbours(TileRef(t));
            const EdgeMasks cutA = cutEdgesOf(signs, TileRef(t), neighbours, bcc::A);
            const EdgeMasks cutB = cutEdgesOf(signs, TileRef(t), neighbours, bcc::B);
            pack(nearer[TileRef(t)], endsOf(cutA), mLeaving.data() + mFirst[t][bcc::A]);
            pack(nearerToB(cutB, nearer, neighbours), endsOf(cutB), mLeaving.data() + mFirst[t][bcc::B]);
        }
    });
}

EdgeMasks Arrows::leaving(TileRef tile, const Neighbours& neighbours, bcc::Lattice lattice) const {
    const TileMask ends = endsOf(cutEdgesOf(mSigns, tile, neighbours, lattice));
    return unpack(ends, mLeaving.data() + mFirst[tile][lattice]);
}

} // namespace vdbtet
