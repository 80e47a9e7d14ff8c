/// @file RankPart.h
/// The tiles of one rank: its own, and those that it borrows.
#pragma once

#include "mpi/TileExchange.h"

#include "emit/Emit.h"
#include "tiles/Layout.h"

#include <vdbtet/mpi/VolumeToTets.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace vdbtet::mpi {

/// All surface tiles, ascending, and who does them; the same on all ranks.
struct Skeleton {
    std::vector<openvdb::Coord> tiles;
    Owner owner;
    /// A run of interior tiles is done by the owners of its tiles whose z is a multiple of this, a power of
    /// two: each up to the next.
    int runStep = 1;

    int runOwner(const openvdb::Coord& tile) const {
        return owner(openvdb::Coord(tile.x(), tile.y(), tile.z() & -runStep));
    }
};

/// @brief A rank's layout: its own surface tiles first, ascending, then the borrowed ones.
/// @details The spans are those of the whole mesh, since ids follow their order; of others' surface tiles
/// they have no record unless it is borrowed.
struct RankPart {
    Layout layout;
    std::vector<bool> lowest;      ///< of each span, whether its lowest vertex is inside
    std::vector<TileRange> ranges; ///< own tiles of both kinds
    /// Of the borrowed tiles next to own surface tiles, whose records stages read; and of those next to own
    /// interior tiles only, whose ids are read.
    std::unique_ptr<TileExchange> beside, far;
};

/// @param own     the numbers of the own tiles in the skeleton, ascending
/// @param ends    of these
/// @param graded  whether interior tiles next to surface tiles will have records
/// @throw UnboundedInside
RankPart makePart(Comm& comm, const Skeleton& skeleton, const std::vector<std::int64_t>& own,
                  const std::vector<TileEnds>& ends, bool graded);

/// @return the record of the first surface tile around an interior tile: its owner has that, too.
TileRef firstSurface(const Spans& spans, const openvdb::Coord& tile);

/// Call @a visit(begin, end) for the parts of a run that a rank owns, offsets of tiles in it.
template <typename Visit>
void forEachOwn(const Skeleton& skeleton, const Span& run, int rank, const Visit& visit) {
    for (std::int64_t begin = 0, end = 0; begin < run.count; begin = end) {
        const openvdb::Coord tile = run.first.offsetBy(0, 0, int(begin));
        const std::int64_t next = (std::int64_t(tile.z()) & -skeleton.runStep) + skeleton.runStep;
        end = std::min(run.count, next - run.first.z());
        if (skeleton.runOwner(tile) == rank) visit(begin, end);
    }
}

/// Ranges in ascending order, those that follow each other in one.
class Ranges {
public:
    void add(const Place& begin, const Place& end) {
        if (!mRanges.empty() && mRanges.back().end.span == begin.span &&
            mRanges.back().end.offset == begin.offset) {
            mRanges.back().end = end;
        } else {
            mRanges.push_back({begin, end});
        }
    }
    /// Those of a run's tiles.
    void addRun(std::int64_t number, const Span& run, std::int64_t begin, std::int64_t end) {
        add({number, begin}, end == run.count ? Place{number + 1, 0} : Place{number, end});
    }
    std::vector<TileRange> take() { return std::move(mRanges); }

private:
    std::vector<TileRange> mRanges;
};

} // namespace vdbtet::mpi
