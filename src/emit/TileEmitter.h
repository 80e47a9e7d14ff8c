/// @file TileEmitter.h
/// Writes, and measures, the points and tets of one tile after another.
#pragma once

#include "bcc/Frame.h"
#include "emit/TileMeasurer.h"
#include "numbering/Numbering.h"
#include "tets/TileTets.h"

#include <vdbtet/MeshSink.h>

namespace vdbtet {

/// Where tiles are written to.
struct Output {
    openvdb::Vec3d* points;
    Tet* tets;
    bool streaming; ///< past the caches, which the mesh would only flush; see drainStores()
};

/// One for each thread.
class TileEmitter {
public:
    TileEmitter(const Vertices& vertices, const Flips& flips, const Numbering& numbering, const Frame& frame)
        : mVertices(vertices), mNumbering(numbering), mFrame(frame), mTets(vertices, flips),
          mMeasurer(vertices) {}

    /// Write tile number @a offset of a span of the layout.
    /// @return where the next tile goes
    Output emit(std::int64_t span, std::int64_t offset, Output out);

    /// Measure a surface tile without writing it.
    void measure(TileRef surface);

    /// What was measured, of written surface tiles too.
    Measure& measured() { return mMeasurer.sum(); }

private:
    /// The ids of the points of a tile.
    struct Ids {
        std::int64_t first[2] = {0, 0};               ///< by lattice
        const TileMask* used[2] = {nullptr, nullptr}; ///< which vertices have one
    };

    /// Those of a slab of equal x.
    struct Slab {
        std::int64_t first;
        std::uint64_t used;
    };

    void emitSurfaceTile(const openvdb::Coord& tile, TileRef surface, Output& out);
    void emitInteriorTile(const openvdb::Coord& tile, Output& out);
    void emitRow(const openvdb::Coord& tile, int lattice, int row, unsigned used, bool streaming,
                 openvdb::Vec3d* points) const;

    /// @param span  of the layout, or -1 outside
    Ids idsOf(std::int64_t span, int tileZ) const;
    /// Look up the ids of all vertices in and around a tile; those of unused vertices are arbitrary.
    void findIds(const openvdb::Coord& tile);
    static Slab slabOf(const Ids& ids, int lattice, int x);
    static void findIds(const Slab (&slabs)[3], int y, std::int64_t* row);

    const Vertices& mVertices;
    const Numbering& mNumbering;
    const Frame& mFrame;
    LocalStates mStates;
    TileTets mTets;
    TileMeasurer mMeasurer;
    std::array<std::int64_t, kLocalVertices> mIds{}; ///< by local number
};

} // namespace vdbtet
