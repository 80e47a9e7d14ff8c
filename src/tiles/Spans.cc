/// @file Spans.cc
/// Columns and spans by binary search.
#include "tiles/Spans.h"

#include <algorithm>

namespace vdbtet {

using openvdb::Coord;

void Spans::append(const Span& span) {
    const int x = span.first.x(), y = span.first.y();
    if (mColumns.empty() || mColumns.back().x != x || mColumns.back().y != y)
        mColumns.push_back({x, y, size(), size()});
    mSpans.push_back(span);
    mColumns.back().end = size();
}

std::vector<Spans::Column>::const_iterator Spans::lowerColumn(int x, int y) const {
    return std::lower_bound(
        mColumns.begin(), mColumns.end(), Coord(x, y, 0),
        [](const Column& c, const Coord& t) { return c.x != t.x() ? c.x < t.x() : c.y < t.y(); });
}

std::int64_t Spans::find(const Coord& tile) const {
    const auto column = lowerColumn(tile.x(), tile.y());
    if (column == mColumns.end() || column->x != tile.x() || column->y != tile.y()) return -1;
    const auto begin = mSpans.begin() + column->begin;
    const auto above = std::upper_bound(begin, mSpans.begin() + column->end, tile.z(),
                                        [](int z, const Span& s) { return z < s.first.z(); });
    if (above == begin || tile.z() >= (above - 1)->first.z() + (above - 1)->count) return -1;
    return above - 1 - mSpans.begin();
}

SpansAround Spans::around(const Coord& tile) const {
    SpansAround around;
    around.fill(-1);
    for (int dx = -1; dx <= 1; ++dx) {
        auto column = lowerColumn(tile.x() + dx, tile.y() - 1);
        for (; column != mColumns.end() && column->x == tile.x() + dx && column->y <= tile.y() + 1;
             ++column) {
            // Backwards from the last span that does not start above the highest neighbour.
            const auto begin = mSpans.begin() + column->begin;
            auto span = std::upper_bound(begin, mSpans.begin() + column->end, tile.z() + 1,
                                         [](int z, const Span& s) { return z < s.first.z(); });
            for (int dz = 1; dz >= -1; --dz) {
                const int z = tile.z() + dz;
                while (span != begin && (span - 1)->first.z() > z) --span;
                if (span == begin) break;
                if (z < (span - 1)->first.z() + (span - 1)->count)
                    around[neighbourSlot(dx, column->y - tile.y(), dz)] = span - 1 - mSpans.begin();
            }
        }
    }
    return around;
}

} // namespace vdbtet
