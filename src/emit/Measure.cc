/// @file Measure.cc
/// Counts, boundary faces, angles and bounds of the mesh (paper, section 4.5).
#include "emit/Measure.h"

#include "emit/BoundaryFaces.h"
#include "emit/TileTets.h"
#include "quality/AngleSum.h"

#include <tbb/enumerable_thread_specific.h>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

/// Measures one tile after another; one for each thread. Sums of integers and extremes, so neither the order
/// nor the thread matters.
class TileMeasurer {
public:
    TileMeasurer(const Vertices& vertices, const Flips& flips, const Numbering& numbering, const Frame& frame)
        : mVertices(vertices), mNumbering(numbering), mFrame(frame), mTets(vertices, flips) {}

    /// @return the number of tets
    std::int64_t measure(TileRef tile) {
        mStates.load(mVertices, tile);
        mPositions.load(mVertices, tile);
        mTets.load(tile, mStates);
        ambiguous += mTets.ambiguous();
        if (mPositions.anyMoved()) {
            addAngles();
            boundaryFaces += countBoundaryFaces(mVertices, tile, mTets, mStates);
            expandBounds(tile);
        } else {
            angles.addLatticeTets(mTets.tets());
        }
        return mTets.tets();
    }

    AngleSum angles;
    std::int64_t ambiguous = 0, boundaryFaces = 0;
    openvdb::BBoxd bounds;

private:
    void addAngles() {
        const auto add = [&](int a, int b, int c, int d) {
            angles.add(mPositions[a], mPositions[b], mPositions[c], mPositions[d]);
        };
        const auto addFlipped = [&](const LocalTet& tet) {
            add(tet.vertex(0), tet.vertex(1), tet.vertex(2), tet.vertex(3));
        };
        for (int axis = 0; axis < 3; ++axis) {
            for (int number = 0; number < 4; ++number) {
                const auto& tet = bcc::kSliceTets[bcc::S][number];
                const TileMask& all = mTets.latticeTets(axis, number);
                TileMask moved = mTets.manifold(axis, tet[0]);
                for (int i = 1; i < 4; ++i) moved |= mTets.manifold(axis, tet[i]);
                moved &= all;
                angles.addLatticeTets(all.count() - moved.count());
                const LocalOctahedron o = localOctahedron(bcc::A, axis, 0);
                moved.forEach([&](int n) {
                    const int base = localIndex(bcc::A, n);
                    add(base + o[tet[0]], base + o[tet[1]], base + o[tet[2]], base + o[tet[3]]);
                });
            }
            mTets.flippedSpines(axis).forEach([&](int n) { mTets.forEachTetOf(axis, n, addFlipped); });
        }
        mTets.forEachTetOfB(addFlipped);
    }

    /// The mesh is bounded by manifold vertices alone, and its points lie in their convex hull.
    void expandBounds(TileRef tile) {
        const openvdb::Coord& at = mVertices.layout.surfaceTiles[tile];
        const Vec3d origin(8.0 * at.x(), 8.0 * at.y(), 8.0 * at.z());
        for (int lattice = 0; lattice < 2; ++lattice) {
            (mNumbering.used[tile][lattice] & mVertices.labels.manifold[tile][lattice]).forEach([&](int n) {
                bounds.expand(mFrame.world(origin + mPositions[localIndex(lattice, n)]));
            });
        }
    }

    const Vertices& mVertices;
    const Numbering& mNumbering;
    const Frame& mFrame;
    LocalStates mStates;
    LocalPositions mPositions;
    TileTets mTets;
};

} // namespace

Measure measureMesh(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
                    const Frame& frame, Interrupt& interrupt) {
    const Layout& layout = vertices.layout;
    const std::int64_t tiles = layout.surfaceCount();
    std::vector<std::int64_t> tets(tiles);
    tbb::enumerable_thread_specific<TileMeasurer> measurers(vertices, flips, numbering, frame);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        TileMeasurer& measurer = measurers.local();
        for (std::int64_t t = begin; t < end; ++t) tets[t] = measurer.measure(TileRef(t));
    });

    Measure measure;
    AngleSum angles;
    for (TileMeasurer& part : measurers) {
        angles.add(part.angles);
        measure.ambiguous += part.ambiguous;
        measure.boundaryTriangles += part.boundaryFaces;
        measure.bounds.expand(part.bounds);
    }
    measure.first.reserve(layout.spans.size() + 1);
    measure.first.push_back(0);
    for (const Layout::Span& span : layout.spans) {
        if (span.surface < 0) angles.addLatticeTets(kInteriorTets * span.count);
        const std::int64_t count = span.surface < 0 ? kInteriorTets * span.count : tets[span.surface];
        measure.first.push_back(measure.first.back() + count);
    }
    measure.angles = angles.stats();
    return measure;
}

} // namespace vdbtet
