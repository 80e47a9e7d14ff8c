/// @file Arrows.cc
/// Signs and cut edges by mask (paper, sections 2.3 and 4.1).
#include "cuts/Arrows.h"

#include <atomic>

namespace vdbtet {

namespace {

/// @return the L_A vertices whose edge in @a direction is cut and has an end in the tile.
PaddedMask cutEdges(const PaddedMask& a, const PaddedMask& b, int direction) {
    // An L_A vertex at 8 has such an edge only where it leads back.
    const bcc::Step step = bcc::shortEdge(bcc::A, direction);
    const int endX = step.x < 0 ? 9 : 8, endY = step.y < 0 ? 9 : 8, endZ = step.z < 0 ? 9 : 8;
    const unsigned row = ((1u << endZ) - 1) << 1;
    PaddedMask cut;
    for (int x = 0; x < endX; ++x) {
        for (int y = 0; y < endY; ++y) {
            const int r = PaddedMask::bit(x, y, -1) / PaddedMask::kRowBits;
            const unsigned far = b.rows[r + step.x * PaddedMask::kDim + step.y];
            cut.rows[r] = std::uint16_t((a.rows[r] ^ far << -step.z) & row);
        }
    }
    return cut;
}

/// What findCuts() makes for one tile.
struct TileCuts {
    TileSigns signs;
    std::unique_ptr<const TileArrows> arrows;
    std::int64_t cutEdges = 0; ///< that start at its L_A vertices
};

/// Finds the signs and arrows of one tile after another.
class TileCutter {
public:
    explicit TileCutter(std::unique_ptr<Field::Sampler> sampler) : mSampler(std::move(sampler)) {}

    TileCuts cut(const openvdb::Coord& tile) {
        TileCuts cuts;
        PaddedMask a, b;
        mSampler->signs(tile, a, b);
        cuts.signs = {a.core(), b.core()};

        std::array<PaddedMask, bcc::kDirections> cut, nearer;
        mEdges.clear();
        for (int d = 0; d < bcc::kDirections; ++d) {
            cut[d] = cutEdges(a, b, d);
            cut[d].forEach(
                [&](int n) { mEdges.push_back({std::uint16_t(n), std::uint16_t(d)}); });
            cuts.cutEdges += cut[d].core().count();
        }
        if (mEdges.empty()) return cuts;

        mNearer.resize(mEdges.size());
        mSampler->nearerToA(tile, mEdges, mNearer.data());
        for (std::size_t i = 0; i < mEdges.size(); ++i)
            nearer[mEdges[i].direction].set(mEdges[i].vertex, mNearer[i]);
        auto arrows = std::make_unique<TileArrows>();
        for (int d = 0; d < bcc::kDirections; ++d) {
            (*arrows)[bcc::A][d] = nearer[d].core();
            cut[d].remove(nearer[d]);
            // From its L_B end the edge runs the opposite way.
            const int back = bcc::opposite(d);
            const bcc::Step step = bcc::shortEdge(bcc::B, back);
            (*arrows)[bcc::B][back] = cut[d].shifted(step.x, step.y, step.z);
        }
        cuts.arrows = std::move(arrows);
        return cuts;
    }

private:
    std::unique_ptr<Field::Sampler> mSampler;
    std::vector<ShortEdge> mEdges;
    std::vector<std::uint8_t> mNearer; ///< of mEdges
};

} // namespace

VertexRef farEnd(const Neighbours& neighbours, const VertexRef& v, int direction) {
    const bcc::Step step = bcc::shortEdge(v.lattice, direction);
    const int x = (v.vertex >> 6) + step.x, y = (v.vertex >> 3 & 7) + step.y, z = (v.vertex & 7) + step.z;
    const TileRef tile = neighbours[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    return {tile, bcc::other(v.lattice), TileMask::bit(x & 7, y & 7, z & 7)};
}

Cuts findCuts(const Field& field, const std::vector<openvdb::Coord>& tiles, Interrupt& interrupt) {
    Cuts cuts;
    cuts.signs.resize(tiles.size());
    cuts.arrows.of.resize(tiles.size());
    std::atomic<std::int64_t> cutEdges{0};
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        TileCutter cutter(field.sampler());
        std::int64_t sum = 0;
        for (std::int64_t t = begin; t < end; ++t) {
            TileCuts tile = cutter.cut(tiles[t]);
            cuts.signs[t] = tile.signs;
            cuts.arrows.of[t] = std::move(tile.arrows);
            sum += tile.cutEdges;
        }
        cutEdges += sum;
    });
    cuts.arrows.cutEdges = cutEdges;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (cuts.arrows.of[t]) cuts.arrows.tiles.push_back(TileRef(t));
    }
    return cuts;
}

} // namespace vdbtet
