/// @file Spans.h
/// Sparse sets of tiles, as runs along z.
#pragma once

#include "bits/TileMask.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// A tile as its neighbours see it: the index of a tile that has a record, or one of the two constants below.
using TileRef = std::int32_t;
constexpr TileRef kInside = -1;    ///< all vertices inside and far from any cut edge
constexpr TileRef kOutside = -2;   ///< all vertices outside and far from any cut edge
constexpr TileRef kElsewhere = -3; ///< in a part of a mesh: a surface tile of another part, not borrowed

/// A tile with a record, or a run of interior tiles that are all alike.
struct Span {
    openvdb::Coord first;   ///< the lowest tile
    std::int64_t count = 1; ///< tiles along z
    TileRef tile = kInside; ///< the index of the tile's record, or kInside for a run
};

/// The spans that hold a tile and its neighbours, by neighbourSlot(); -1 where there is none.
using SpansAround = std::array<std::int64_t, 27>;

/// Spans that do not overlap, in ascending order of their tiles.
class Spans {
public:
    /// Append a span above all others.
    void append(const Span& span);

    std::int64_t size() const { return std::int64_t(mSpans.size()); }
    const Span& operator[](std::int64_t s) const { return mSpans[s]; }
    std::vector<Span>::const_iterator begin() const { return mSpans.begin(); }
    std::vector<Span>::const_iterator end() const { return mSpans.end(); }

    /// @return the span that holds a tile, or -1
    std::int64_t find(const openvdb::Coord& tile) const;

    SpansAround around(const openvdb::Coord& tile) const;

    /// Call @a visit(s) for each span that has a tile in a box.
    template <typename Visit>
    void forEachIn(const openvdb::CoordBBox& box, Visit&& visit) const {
        for (int x = box.min().x(); x <= box.max().x(); ++x) {
            for (auto column = lowerColumn(x, box.min().y());
                 column != mColumns.end() && column->x == x && column->y <= box.max().y(); ++column) {
                auto s = std::partition_point(
                             mSpans.begin() + column->begin, mSpans.begin() + column->end,
                             [&](const Span& span) { return span.first.z() + span.count <= box.min().z(); }) -
                         mSpans.begin();
                for (; s < column->end && mSpans[s].first.z() <= box.max().z(); ++s) visit(s);
            }
        }
    }

private:
    /// The tiles of equal x and y.
    struct Column {
        int x, y;
        std::int64_t begin, end; ///< its spans
    };

    std::vector<Column>::const_iterator lowerColumn(int x, int y) const;

    std::vector<Span> mSpans;
    std::vector<Column> mColumns;
};

} // namespace vdbtet
