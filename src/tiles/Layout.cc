/// @file Layout.cc
/// Runs between surface tiles, by signs.
#include "tiles/Layout.h"

#include <vdbtet/Errors.h>

#include <utility>

namespace vdbtet {

using openvdb::Coord;

namespace {

bool sameColumn(const Coord& a, const Coord& b) { return a.x() == b.x() && a.y() == b.y(); }

[[noreturn]] void throwUnbounded() {
    throw UnboundedInside(
        "the inside has no end along an axis; close it, or mesh the other side of the isovalue");
}

} // namespace

Spans makeSpans(const std::vector<Coord>& surfaceTiles, const std::vector<TileEnds>& ends) {
    // Away from the surface a tile has one sign, which it shares with the nearest vertices of the next tile.
    Spans spans;
    const std::int64_t count = std::int64_t(surfaceTiles.size());
    for (std::int64_t t = 0; t < count; ++t) {
        const Coord& tile = surfaceTiles[t];
        const bool starts = t == 0 || !sameColumn(surfaceTiles[t - 1], tile);
        const bool last = t + 1 == count || !sameColumn(surfaceTiles[t + 1], tile);
        if (starts && ends[t].lowest) throwUnbounded();
        spans.append({tile, 1, TileRef(t)});
        if (!ends[t].highest) continue;
        if (last) throwUnbounded();
        const std::int64_t gap = std::int64_t(surfaceTiles[t + 1].z()) - tile.z() - 1;
        if (gap > 0) spans.append({tile.offsetBy(0, 0, 1), gap, kInside});
    }
    return spans;
}

Layout makeLayout(std::vector<Coord> surfaceTiles, const std::vector<TileSigns>& signs,
                  Interrupt& interrupt) {
    const std::int64_t count = std::int64_t(surfaceTiles.size());
    std::vector<TileEnds> ends;
    ends.reserve(signs.size());
    for (const TileSigns& tile : signs) ends.push_back(TileEnds::of(tile));
    Layout layout;
    layout.spans = makeSpans(surfaceTiles, ends);
    layout.surfaceTiles = std::move(surfaceTiles);
    layout.neighbours.resize(std::size_t(count));
    interrupt.expectLoops(1);
    parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const auto around = layout.spans.around(layout.surfaceTiles[t]);
            for (int slot = 0; slot < 27; ++slot)
                layout.neighbours[t][slot] = around[slot] < 0 ? kOutside : layout.spans[around[slot]].tile;
        }
    });
    return layout;
}

} // namespace vdbtet
