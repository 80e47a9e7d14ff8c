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

std::int64_t Layout::find(const Coord& tile) const {
    const auto column =
        std::lower_bound(columns.begin(), columns.end(), tile, [](const Column& c, const Coord& t) {
            return c.x != t.x() ? c.x < t.x() : c.y < t.y();
        });
    if (column == columns.end() || column->x != tile.x() || column->y != tile.y()) return -1;
    const auto after = std::upper_bound(spans.begin() + column->begin, spans.begin() + column->end, tile.z(),
                                        [](int z, const Span& s) { return z < s.first.z(); });
    if (after == spans.begin() + column->begin) return -1;
    const auto span = after - 1;
    return tile.z() < span->first.z() + span->count ? span - spans.begin() : -1;
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
        layout.surfaceSpans.push_back(std::int64_t(layout.spans.size()));
        layout.spans.push_back({tile, 1, TileRef(t)});
        if (!signs[t][bcc::A].test(kTop)) continue;
        if (ends) throwUnbounded();
        const std::int64_t gap = std::int64_t(surfaceTiles[t + 1].z()) - tile.z() - 1;
        if (gap > 0) layout.spans.push_back({tile.offsetBy(0, 0, 1), gap, kInside});
    }
    layout.columns = columnsOf(layout.spans);
    layout.surfaceTiles = std::move(surfaceTiles);

    layout.neighbours.resize(layout.surfaceTiles.size());
    parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            for (int slot = 0; slot < 27; ++slot) {
                const Coord step(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
                const std::int64_t span = layout.find(layout.surfaceTiles[t] + step);
                layout.neighbours[t][slot] = span < 0 ? kOutside : layout.spans[span].surface;
            }
        }
    });
    return layout;
}

} // namespace vdbtet
