/// @file Arrows.cc
/// Signs and cut edges by mask (paper, sections 2.3 and 4.1).
#include "cuts/Arrows.h"

#include <tbb/enumerable_thread_specific.h>

#include <atomic>

namespace vdbtet {

namespace {

/// The L_A vertices whose edge in a direction has an end in the tile: one at 8 only where the edge leads
/// back.
PaddedEdgeMasks edgesOfTile() {
    PaddedEdgeMasks edges;
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(bcc::A, d);
        for (int x = 0; x < 8 - step.x; ++x) {
            for (int y = 0; y < 8 - step.y; ++y) {
                for (int z = 0; z < 8 - step.z; ++z) edges[d].set(PaddedMask::bit(x, y, z));
            }
        }
    }
    return edges;
}

/// @return those of edgesOfTile() in @a direction for whose ends, in rows of @a a and @a b, @a of(a, b) has a
/// bit.
template <typename Of>
PaddedMask edgesByEnds(const PaddedMask& a, const PaddedMask& b, int direction, Of&& of) {
    static const auto kEdges = edgesOfTile();
    const bcc::Step step = bcc::shortEdge(bcc::A, direction);
    constexpr int kFirst = PaddedMask::bit(0, 0, -1) / PaddedMask::kRowBits;
    const int toFar = step.x * PaddedMask::kDim + step.y;
    PaddedMask edges;
    for (int r = kFirst; r < PaddedMask::kRows; ++r)
        edges.rows[r] =
            std::uint16_t(of(a.rows[r], b.rows[r + toFar] << -step.z) & kEdges[direction].rows[r]);
    return edges;
}
PaddedMask edgesWithOneEnd(const PaddedMask& a, const PaddedMask& b, int direction) {
    return edgesByEnds(a, b, direction, [](int ownRow, int farRow) { return ownRow ^ farRow; });
}
PaddedMask edgesWithAnyEnd(const PaddedMask& a, const PaddedMask& b, int direction) {
    return edgesByEnds(a, b, direction, [](int ownRow, int farRow) { return ownRow | farRow; });
}

/// @return how many tets around the spines from a tile's L_A vertices have inside vertices alone, whichever
/// way their octahedra are cut: each tet of the lattice is around one such spine.
std::int64_t countInsideTets(const PaddedMask& a, const PaddedMask& b) {
    const TileMask own = a.core();
    if (!own.any()) return 0;
    std::int64_t octahedra = 0;
    for (const bcc::Octahedron& octahedron : bcc::kOctahedra[bcc::A]) {
        TileMask inside = own;
        for (const bcc::Vertex& v : octahedron) {
            const PaddedMask& mask = v.lattice == bcc::A ? a : b;
            inside &= mask.shifted(v.x, v.y, v.z);
        }
        octahedra += inside.count();
    }
    return 4 * octahedra;
}

/// What findCuts() makes for one tile.
struct TileCuts {
    TileSigns signs;
    std::unique_ptr<const TileArrows> arrows;
    std::int64_t cutEdges = 0; ///< that start at its L_A vertices
    std::int64_t insideTets = 0;
};

/// Finds the signs and arrows of one tile after another.
class TileCutter {
public:
    explicit TileCutter(std::unique_ptr<Field::Sampler> sampler) : mSampler(std::move(sampler)) {}

    /// @param flagged  in and around the tile, by lattice
    TileCuts cut(const openvdb::Coord& tile, double tau,
                 const std::array<PaddedMask, 2>& flagged = std::array<PaddedMask, 2>()) {
        TileCuts cuts;
        PaddedMask a, b;
        mSampler->signs(tile, a, b);
        cuts.signs = {a.core(), b.core()};
        cuts.insideTets = countInsideTets(a, b);

        PaddedEdgeMasks cut, nearer;
        bool any = false;
        for (int d = 0; d < bcc::kDirections; ++d) {
            cut[d] = edgesWithOneEnd(a, b, d);
            any = any || cut[d].any();
            cuts.cutEdges += cut[d].core().count();
        }
        if (!any) return cuts;
        if (flagged[bcc::A].any() || flagged[bcc::B].any()) {
            PaddedEdgeMasks halved = cut, others = cut;
            for (int d = 0; d < bcc::kDirections; ++d) {
                const PaddedMask atEnds = edgesWithAnyEnd(flagged[bcc::A], flagged[bcc::B], d);
                halved[d].intersect(atEnds);
                others[d].remove(atEnds);
            }
            mSampler->nearerToA(tile, halved, 0.5, nearer);
            mSampler->nearerToA(tile, others, tau, nearer);
        } else {
            mSampler->nearerToA(tile, cut, tau, nearer);
        }
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
};

} // namespace

VertexRef farEnd(const Neighbours& neighbours, const VertexRef& v, int direction) {
    const bcc::Step step = bcc::shortEdge(v.lattice, direction);
    const int x = (v.vertex >> 6) + step.x, y = (v.vertex >> 3 & 7) + step.y, z = (v.vertex & 7) + step.z;
    const TileRef tile = neighbours[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    return {tile, bcc::other(v.lattice), TileMask::bit(x & 7, y & 7, z & 7)};
}

Cuts findCuts(const Field& field, const std::vector<openvdb::Coord>& tiles, double tau, Interrupt& interrupt,
              std::int64_t mostTets) {
    Cuts cuts;
    cuts.signs.resize(tiles.size());
    cuts.arrows.of.resize(tiles.size());
    std::atomic<std::int64_t> cutEdges{0}, insideTets{0};
    tbb::enumerable_thread_specific<TileCutter> cutters([&] { return TileCutter(field.sampler()); });
    interrupt.expectLoops(1);
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        if (insideTets > mostTets) return;
        TileCutter& cutter = cutters.local();
        std::int64_t edges = 0, tets = 0;
        for (std::int64_t t = begin; t < end; ++t) {
            TileCuts tile = cutter.cut(tiles[t], tau);
            cuts.signs[t] = tile.signs;
            cuts.arrows.of[t] = std::move(tile.arrows);
            edges += tile.cutEdges;
            tets += tile.insideTets;
        }
        cutEdges += edges;
        insideTets += tets;
    });
    cuts.arrows.cutEdges = cutEdges;
    cuts.insideTets = insideTets;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (cuts.arrows.of[t]) cuts.arrows.tiles.push_back(TileRef(t));
    }
    return cuts;
}

void turnArrows(const Field& field, const Layout& layout, const Threshold& threshold,
                const std::vector<TileRef>& tiles, Arrows& arrows, Interrupt& interrupt) {
    tbb::enumerable_thread_specific<TileCutter> cutters([&] { return TileCutter(field.sampler()); });
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        TileCutter& cutter = cutters.local();
        for (std::int64_t i = begin; i < end; ++i) {
            const TileRef t = tiles[i];
            if (!arrows.of[t]) continue;
            const Surroundings around(layout.neighbours[t]);
            const std::array<PaddedMask, 2> flagged{PaddedMask(around.masks(*threshold.flagged, bcc::A)),
                                                    PaddedMask(around.masks(*threshold.flagged, bcc::B))};
            arrows.of[t] = cutter.cut(layout.surfaceTiles[t], threshold.tau, flagged).arrows;
        }
    });
}

} // namespace vdbtet
