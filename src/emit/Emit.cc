/// @file Emit.cc
/// Chunks of tiles through an ordered pipeline.
#include "emit/Emit.h"

#include <tbb/concurrent_queue.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

namespace vdbtet {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

/// A chunk is this many tiles: about 49,000 tets in the interior.
constexpr std::int64_t kTilesPerChunk = 8;

/// The tiles of a chunk: some of them from a span on.
struct Unit {
    std::int64_t span;   ///< in the layout
    std::int64_t offset; ///< of the first tile in its span
    std::int64_t tiles;
};

/// Cuts the layout into units.
class Units {
public:
    explicit Units(const Layout& layout) : mLayout(layout) {}

    bool done() const { return mSpan == std::int64_t(mLayout.spans.size()); }

    Unit next() {
        Unit unit{mSpan, mOffset, 0};
        while (unit.tiles < kTilesPerChunk && !done()) {
            const std::int64_t left = mLayout.spans[mSpan].count - mOffset;
            const std::int64_t taken = std::min(left, kTilesPerChunk - unit.tiles);
            unit.tiles += taken;
            mOffset += taken;
            if (taken == left) ++mSpan, mOffset = 0;
        }
        return unit;
    }

private:
    const Layout& mLayout;
    std::int64_t mSpan = 0, mOffset = 0;
};

using LocalTets = std::vector<std::array<std::uint16_t, 4>>;

/// The tets of an interior tile by the local numbers of their vertices, in the order of TetWalk.
const LocalTets& interiorTets() {
    static const LocalTets kTets = [] {
        LocalTets tets;
        tets.reserve(kInteriorTets);
        for (int axis = 0; axis < 3; ++axis) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                const LocalOctahedron o = localOctahedron(bcc::A, axis, localIndex(bcc::A, n));
                for (const auto& tet : bcc::kSliceTets[bcc::S]) {
                    tets.push_back({std::uint16_t(o[tet[0]]), std::uint16_t(o[tet[1]]),
                                    std::uint16_t(o[tet[2]]), std::uint16_t(o[tet[3]])});
                }
            }
        }
        return tets;
    }();
    return kTets;
}

/// Where the ids of a tile's points start, and which of its vertices have one.
struct IdRange {
    std::int64_t first;
    const TileMask* used[2];
};

/// Builds chunks; one for each thread.
class ChunkBuilder {
public:
    ChunkBuilder(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
                 const Measure& measure, const Frame& frame)
        : mVertices(vertices), mNumbering(numbering), mMeasure(measure), mFrame(frame),
          mWalk(vertices, flips), mIds(kLocalVertices) {}

    void build(const Unit& unit, MeshChunk& chunk) {
        const Layout& layout = mVertices.layout;
        chunk.points.clear();
        chunk.tets.clear();
        chunk.firstPoint = mNumbering.first[unit.span] + kInteriorPoints * unit.offset;
        chunk.firstTet = mMeasure.first[unit.span] + kInteriorTets * unit.offset;
        std::int64_t span = unit.span, offset = unit.offset;
        for (std::int64_t i = 0; i < unit.tiles; ++i) {
            const Layout::Span& s = layout.spans[span];
            const Coord tile = s.first.offsetBy(0, 0, int(offset));
            if (s.surface >= 0) {
                addSurfaceTile(tile, s.surface, chunk);
            } else {
                addInteriorTile(tile, chunk);
            }
            if (++offset == s.count) ++span, offset = 0;
        }
    }

private:
    void addSurfaceTile(const Coord& tile, TileRef surface, MeshChunk& chunk) {
        mWalk.load(surface);
        findIds(tile);
        const LocalVertices& local = mWalk.local();
        const Vec3d origin(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z());
        for (int lattice = 0; lattice < 2; ++lattice) {
            mNumbering.used[surface][lattice].forEach([&](int n) {
                chunk.points.push_back(mFrame.world(origin + local.position(localIndex(lattice, n))));
            });
        }
        mWalk.forEachTet([&](const LocalTet& tet, int) {
            chunk.tets.push_back(
                {mIds[tet.vertex(0)], mIds[tet.vertex(1)], mIds[tet.vertex(2)], mIds[tet.vertex(3)]});
        });
    }

    void addInteriorTile(const Coord& tile, MeshChunk& chunk) {
        findIds(tile);
        const Vec3d origin(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z());
        for (int lattice = 0; lattice < 2; ++lattice) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                chunk.points.push_back(mFrame.world(origin + LocalVertices::home(localIndex(lattice, n))));
            }
        }
        for (const auto& tet : interiorTets()) {
            chunk.tets.push_back({mIds[tet[0]], mIds[tet[1]], mIds[tet[2]], mIds[tet[3]]});
        }
    }

    /// @param span  of the layout, or -1 outside
    /// @param z     of the tile in it
    IdRange idRange(std::int64_t span, int z) const {
        if (span < 0) return {0, {&mNone, &mNone}};
        const Layout::Span& s = mVertices.layout.spans[span];
        if (s.surface < 0) {
            const std::int64_t offset = std::int64_t(z) - s.first.z();
            return {mNumbering.first[span] + kInteriorPoints * offset, {&mAll, &mAll}};
        }
        const auto& used = mNumbering.used[s.surface];
        return {mNumbering.first[span], {&used[bcc::A], &used[bcc::B]}};
    }

    /// Look up the ids of all vertices in and around a tile; those of unused vertices are arbitrary.
    void findIds(const Coord& tile) {
        const auto spans = mVertices.layout.spansAround(tile);
        for (int slot = 0; slot < 27; ++slot) {
            const int step[3] = {slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1};
            const IdRange range = idRange(spans[slot], tile.z() + step[2]);
            auto first = [](int s) { return s < 0 ? -1 : s > 0 ? 8 : 0; };
            auto last = [](int s) { return s < 0 ? -1 : s > 0 ? 8 : 7; };
            std::int64_t base = range.first;
            for (int lattice = 0; lattice < 2; ++lattice) {
                const TileMask& used = *range.used[lattice];
                for (int x = first(step[0]); x <= last(step[0]); ++x) {
                    for (int y = first(step[1]); y <= last(step[1]); ++y) {
                        const int row = TileMask::bit(x & 7, y & 7, 0);
                        const std::int64_t before = base + used.rank(row);
                        const unsigned bits = unsigned(used.words[row >> 6] >> (row & 63) & 0xff);
                        for (int z = first(step[2]); z <= last(step[2]); ++z) {
                            mIds[localIndex(lattice, x, y, z)] =
                                before + countBits(bits & ((1u << (z & 7)) - 1));
                        }
                    }
                }
                base += used.count();
            }
        }
    }

    const Vertices& mVertices;
    const Numbering& mNumbering;
    const Measure& mMeasure;
    const Frame& mFrame;
    TetWalk mWalk;
    std::vector<std::int64_t> mIds; ///< by local number
    TileMask mNone = TileMask::filled(false), mAll = TileMask::filled(true);
};

} // namespace

void emitMesh(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
              const Measure& measure, const Frame& frame, MeshSink& sink, Interrupt& interrupt) {
    using ChunkPtr = std::unique_ptr<MeshChunk>;
    tbb::enumerable_thread_specific<std::unique_ptr<ChunkBuilder>> builders(
        [&] { return std::make_unique<ChunkBuilder>(vertices, flips, numbering, measure, frame); });
    tbb::concurrent_queue<ChunkPtr> spare; // fresh pages cost more than the tets that fill them
    Units units(vertices.layout);

    const auto cut = [&](tbb::flow_control& flow) -> Unit {
        if (units.done() || interrupt.stopped()) {
            flow.stop();
            return {};
        }
        return units.next();
    };
    const auto build = [&](const Unit& unit) {
        ChunkPtr chunk;
        if (!spare.try_pop(chunk)) chunk = std::make_unique<MeshChunk>();
        builders.local()->build(unit, *chunk);
        return chunk.release();
    };
    const auto pass = [&](MeshChunk* raw) {
        ChunkPtr chunk(raw);
        const double done = double(chunk->firstTet) / double(std::max<std::int64_t>(1, measure.tets()));
        if (interrupt.poll(int(100.0 * done))) return;
        sink.chunk(*chunk);
        spare.push(std::move(chunk));
    };
    const size_t tokens = 2 * size_t(tbb::this_task_arena::max_concurrency());
    tbb::parallel_pipeline(tokens,
                           tbb::make_filter<void, Unit>(tbb::filter_mode::serial_in_order, cut) &
                               tbb::make_filter<Unit, MeshChunk*>(tbb::filter_mode::parallel, build) &
                               tbb::make_filter<MeshChunk*, void>(tbb::filter_mode::serial_in_order, pass));
}

} // namespace vdbtet
