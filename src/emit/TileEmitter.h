/// @file TileEmitter.h
/// Writes, and measures, the points and tets of one tile after another.
#pragma once

#include "bcc/Frame.h"
#include "emit/PointIds.h"
#include "emit/TetShapes.h"
#include "emit/TileMeasurer.h"
#include "numbering/Numbering.h"
#include "tets/BoundaryFaces.h"
#include "tets/TileTets.h"

#include <vdbtet/MeshSink.h>

#include <vector>

namespace vdbtet {

/// The boundary of a chunk.
struct ChunkBoundary {
    std::vector<Triangle> triangles;
    std::vector<std::int64_t> points;

    void clear() {
        triangles.clear();
        points.clear();
    }
};

/// Where tiles are written to.
struct Output {
    openvdb::Vec3d* points;
    Tet* tets;
    ChunkBoundary* boundary; ///< null if nobody wants it
    TetShapes* shapes;       ///< the same
    bool streaming;          ///< past the caches, which the mesh would only flush; see drainStores()
};

/// One for each thread.
class TileEmitter {
public:
    TileEmitter(const Vertices& vertices, const Flips& flips, const Grading& grading,
                const Numbering& numbering, const Frame& frame)
        : mVertices(vertices), mGrading(grading), mNumbering(numbering), mFrame(frame),
          mTets(vertices, flips), mIds(grading, numbering), mMeasurer(vertices) {}

    /// Write tile number @a offset of a span of a tier.
    /// @return where the next tile goes
    Output emit(int tier, std::int64_t span, std::int64_t offset, Output out);

    /// Measure a tile without writing it.
    void measure(int tier, std::int64_t span);

    /// What was measured, of written tiles too. Only tets of surface tiles are; of the others Numbering knows
    /// the angles.
    AngleSum& measured() { return mMeasurer.sum(); }

private:
    /// @return whether the tile has tets of the lattice itself
    bool load(int tier, const openvdb::Coord& tile, TileRef surface, const SpansAround& around);
    void emitRunTile(const openvdb::Coord& tile, Output& out);
    void emitSurfacePoints(const openvdb::Coord& tile, TileRef record, TileRef surface, Output& out);
    void emitPoints(int tier, const openvdb::Coord& tile, int lattice, const TileMask& used, bool streaming,
                    Output& out);
    void emitRow(int tier, const openvdb::Coord& tile, int lattice, int row, unsigned used, bool streaming,
                 openvdb::Vec3d* points) const;
    /// Find the boundary faces, and go to the tile's tets as they are.
    void findBoundary(TileRef surface);
    void emitCells(TileRef surface, Output& out);
    /// Put the copies of vertices into the tile's tets.
    void putCopies(const TileChanges& changes, Tet* tets) const;
    void emitBoundary(TileRef record, TileRef surface, ChunkBoundary& boundary);
    const TileMask& usedIn(TileRef record, TileRef surface, int lattice) const {
        return lattice == bcc::A ? mNumbering.usedA[0][record] : mNumbering.usedB[surface];
    }
    void emitOctants(Output& out);
    /// Of the tets just written.
    void addRunShapes(const openvdb::Coord& tile, TetShapes& shapes);
    void addCellShapes(const openvdb::Coord& tile, TileRef surface, TetShapes& shapes);
    void addOctantShapes(int tier, const openvdb::Coord& tile, TetShapes& shapes) const;

    const Vertices& mVertices;
    const Grading& mGrading;
    const Numbering& mNumbering;
    const Frame& mFrame;
    LocalStates mStates;
    LocalOctants mOctants;
    TileTets mTets;
    PointIds mIds;
    std::vector<LocalFace> mFaces;
    TileMeasurer mMeasurer;
    std::vector<Tet> mLocalTets; ///< by local numbers instead of ids
};

} // namespace vdbtet
