/// @file RankRepair.cc
/// A mesh of its own for the tiles around the bad vertices.
#include "mpi/RankRepair.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <utility>

namespace vdbtet::mpi {

using openvdb::Coord;

namespace {

/// @return the tiles, and all around them up to @a rings away; ascending.
std::vector<Coord> dilated(std::vector<Coord> tiles, int rings) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t count = tiles.size();
        for (int step = -rings; step <= rings; ++step) {
            for (std::size_t i = 0; i < count && step != 0; ++i) {
                Coord tile = tiles[i];
                tile[axis] += step;
                tiles.push_back(tile);
            }
        }
        tbb::parallel_sort(tiles.begin(), tiles.end());
        tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    }
    return tiles;
}

bool has(const std::vector<Coord>& tiles, const Coord& tile) {
    return std::binary_search(tiles.begin(), tiles.end(), tile);
}

/// The records of a tile.
struct Record {
    Coord tile;
    TileSigns signs;
    std::array<TileMask, 2> manifold;
    std::vector<float> distances; // of destinations, as the next two
    std::vector<std::uint8_t> directions;
    std::vector<openvdb::Vec3f> offsets;
    std::vector<std::uint16_t> flips;
};

/// @param all  may be empty: then so is the list
template <typename T>
void packSome(const std::vector<T>& all, std::int64_t begin, std::int64_t end, Bytes& bytes) {
    packList(bytes, all.empty() ? all : std::vector<T>(all.begin() + begin, all.begin() + end));
}

void packRecord(const Vertices& vertices, const Flips& flips, TileRef t, Bytes& bytes) {
    const Destinations& destinations = vertices.destinations;
    const std::int64_t begin = destinations.first[std::size_t(t)][0],
                       end = destinations.first[std::size_t(t) + 1][0];
    pack(bytes, vertices.layout.surfaceTiles[std::size_t(t)]);
    pack(bytes, vertices.signs[std::size_t(t)]);
    pack(bytes, vertices.labels.manifold[std::size_t(t)]);
    packSome(destinations.distances, begin, end, bytes);
    packSome(destinations.directions, begin, end, bytes);
    packSome(destinations.offsets, begin, end, bytes);
    packSome(flips.codes, flips.first[std::size_t(t)], flips.first[std::size_t(t) + 1], bytes);
}

Record unpackRecord(Unpacker& next) {
    Record record;
    next(&record.tile, 1);
    next(&record.signs, 1);
    next(&record.manifold, 1);
    record.distances = next.nextList<float>();
    record.directions = next.nextList<std::uint8_t>();
    record.offsets = next.nextList<openvdb::Vec3f>();
    record.flips = next.nextList<std::uint16_t>();
    return record;
}

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

/// A mesh of some tiles, in the order that they have in the whole one; beyond them it is taken to be outside.
class Piece {
public:
    /// @param spans  of the whole mesh
    Piece(std::vector<Record> records, const Spans& spans) {
        tbb::parallel_sort(records.begin(), records.end(),
                           [](const Record& a, const Record& b) { return a.tile < b.tile; });
        for (const Record& record : records) {
            mLayout.surfaceTiles.push_back(record.tile);
            mSigns.push_back(record.signs);
            mLabels.manifold.push_back(record.manifold);
        }
        mDestinations.number(mLabels.manifold);
        mFlips.first.push_back(0);
        for (const Record& record : records) {
            append(mDestinations.distances, record.distances);
            append(mDestinations.directions, record.directions);
            append(mDestinations.offsets, record.offsets);
            append(mFlips.codes, record.flips);
            mFlips.first.push_back(std::int64_t(mFlips.codes.size()));
            const SpansAround around = spans.around(record.tile);
            Neighbours& neighbours = mLayout.neighbours.emplace_back();
            for (int slot = 0; slot < 27; ++slot) {
                const std::int64_t span = around[std::size_t(slot)];
                const bool inside = span >= 0 && spans[span].tile == kInside;
                const TileRef tile = find(record.tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1));
                neighbours[std::size_t(slot)] = inside ? kInside : tile;
            }
        }
    }

    /// @return the number of a tile here, or kOutside
    TileRef find(const Coord& tile) const {
        const auto& tiles = mLayout.surfaceTiles;
        const auto at = std::lower_bound(tiles.begin(), tiles.end(), tile);
        return at == tiles.end() || *at != tile ? kOutside : TileRef(at - tiles.begin());
    }
    const Coord& tile(TileRef t) const { return mLayout.surfaceTiles[std::size_t(t)]; }

    Repair mend(std::vector<std::int64_t> bad, Boundary mode, Interrupt& interrupt) const {
        return mendBoundary(Vertices{mLayout, mSigns, mLabels, mDestinations}, mFlips, std::move(bad), mode,
                            interrupt);
    }

private:
    Layout mLayout;
    std::vector<TileSigns> mSigns;
    Labels mLabels;
    Destinations mDestinations;
    Flips mFlips;
};

/// A vertex, whatever the tile's number.
struct BadVertex {
    Coord tile;
    std::int32_t rest; ///< of a VertexId
};

} // namespace

Repair repairPart(Comm& comm, const Vertices& vertices, const Flips& flips, Boundary mode,
                  Interrupt& interrupt) {
    const Layout& layout = vertices.layout;
    constexpr std::int64_t kRest = 1023; // lattice and bit of a VertexId
    std::vector<BadVertex> own, bad;
    comm.together([&] {
        for (const std::int64_t vertex : findPinched(vertices, flips, interrupt))
            own.push_back(
                {layout.surfaceTiles[std::size_t(VertexId::tile(vertex))], std::int32_t(vertex & kRest)});
    });
    comm.forEachRank(own, [&](const auto& some) { bad.insert(bad.end(), some.begin(), some.end()); });
    Repair repair;
    repair.counts.found = repair.counts.left = std::int64_t(bad.size());
    if (bad.empty() || mode == Boundary::Raw) return repair;

    std::vector<Coord> badTiles;
    for (const BadVertex& vertex : bad) badTiles.push_back(vertex.tile);
    badTiles = dilated(std::move(badTiles), 0);
    // Mending reads two tiles beyond what it changes. Should it come farther than thought, more are gathered.
    constexpr int kRead = 2;
    for (int reach = 1;; reach *= 2) {
        const std::vector<Coord> wanted = dilated(badTiles, reach + kRead);
        Bytes records;
        for (TileRef t = 0; t < layout.ownCount(); ++t) {
            if (has(wanted, layout.surfaceTiles[std::size_t(t)])) packRecord(vertices, flips, t, records);
        }
        std::vector<Record> all;
        comm.forEachRank(records, [&](const Bytes& some) {
            for (Unpacker next(some); !next.done();) all.push_back(unpackRecord(next));
        });
        const Piece piece(std::move(all), layout.spans);
        std::vector<std::int64_t> ids;
        for (const BadVertex& vertex : bad)
            ids.push_back(VertexId::of(piece.find(vertex.tile), 0, 0) | vertex.rest);
        std::sort(ids.begin(), ids.end());
        comm.together([&] { repair = piece.mend(std::move(ids), mode, interrupt); });

        const std::vector<Coord> reached = dilated(badTiles, reach);
        if (!std::all_of(repair.changed.begin(), repair.changed.end(), [&](std::int64_t vertex) {
                return has(reached, piece.tile(VertexId::tile(vertex)));
            }))
            continue;
        Changes changes;
        for (const Coord& tile : layout.surfaceTiles) {
            const TileChanges* its = repair.changes.of(piece.find(tile));
            changes.numbers.push_back(its ? std::int32_t(changes.tiles.size()) : -1);
            if (its) changes.tiles.push_back(*its);
        }
        repair.changes = std::move(changes);
        repair.pinched.clear();
        return repair;
    }
}

} // namespace vdbtet::mpi
