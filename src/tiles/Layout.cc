/// @file Layout.cc
/// Runs of tiles, and neighbours by binary search.
#include "tiles/Layout.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <utility>

namespace vdbtet {

using openvdb::Coord;

namespace {

bool sameColumn(const Coord& a, const Coord& b) { return a.x() == b.x() && a.y() == b.y(); }

[[noreturn]] void throwUnbounded() {
    throw UnboundedInside(
        "the inside has no end along an axis; close it, or mesh the other side of the isovalue");
}

std::vector<Layout::Column> columnsOf(const std::vector<Layout::Span>& spans) {
    std::vector<Layout::Column> columns;
    for (std::int64_t s = 0; s < std::int64_t(spans.size()); ++s) {
        if (s == 0 || !sameColumn(spans[s].first, spans[s - 1].first)) {
            columns.push_back({spans[s].first.x(), spans[s].first.y(), s, s});
        }
        columns.back().end = s + 1;
    }
    return columns;
}

} // namespace

std::array<std::int64_t, 27> Layout::spansAround(const Coord& tile) const {
    std::array<std::int64_t, 27> around;
    around.fill(-1);
    for (int dx = -1; dx <= 1; ++dx) {
        auto column = std::lower_bound(
            columns.begin(), columns.end(), Coord(tile.x() + dx, tile.y() - 1, 0),
            [](const Column& c, const Coord& t) { return c.x != t.x() ? c.x < t.x() : c.y < t.y(); });
        for (; column != columns.end() && column->x == tile.x() + dx && column->y <= tile.y() + 1; ++column) {
            // Backwards from the last span that does not start above the highest neighbour.
            auto span = std::upper_bound(spans.begin() + column->begin, spans.begin() + column->end,
                                         tile.z() + 1, [](int z, const Span& s) { return z < s.first.z(); });
            for (int dz = 1; dz >= -1; --dz) {
                const int z = tile.z() + dz;
                while (span != spans.begin() + column->begin && (span - 1)->first.z() > z) --span;
                if (span == spans.begin() + column->begin) break;
                if (z < (span - 1)->first.z() + (span - 1)->count) {
                    around[neighbourSlot(dx, column->y - tile.y(), dz)] = span - 1 - spans.begin();
                }
            }
        }
    }
    return around;
}

Layout makeLayout(std::vector<Coord> surfaceTiles, const std::vector<TileSigns>& signs,
                  Interrupt& interrupt) {
    // Away from the surface a tile has one sign, which it shares with the nearest vertices of the next tile.
    constexpr int kBottom = TileMask::bit(0, 0, 0), kTop = TileMask::bit(0, 0, 7);
    Layout layout;
    const std::int64_t count = std::int64_t(surfaceTiles.size());
    for (std::int64_t t = 0; t < count; ++t) {
        const Coord& tile = surfaceTiles[t];
        const bool starts = t == 0 || !sameColumn(surfaceTiles[t - 1], tile);
        const bool ends = t + 1 == count || !sameColumn(surfaceTiles[t + 1], tile);
        if (starts && signs[t][bcc::A].test(kBottom)) throwUnbounded();
        layout.spans.push_back({tile, 1, TileRef(t)});
        if (!signs[t][bcc::A].test(kTop)) continue;
        if (ends) throwUnbounded();
        const std::int64_t gap = std::int64_t(surfaceTiles[t + 1].z()) - tile.z() - 1;
        if (gap > 0) layout.spans.push_back({tile.offsetBy(0, 0, 1), gap, kInside});
    }
    layout.columns = columnsOf(layout.spans);
    layout.surfaceTiles = std::move(surfaceTiles);
    layout.neighbours.resize(std::size_t(count));
    parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const auto around = layout.spansAround(layout.surfaceTiles[t]);
            for (int slot = 0; slot < 27; ++slot)
                layout.neighbours[t][slot] = around[slot] < 0 ? kOutside : layout.spans[around[slot]].surface;
        }
    });
    return layout;
}

} // namespace vdbtet
