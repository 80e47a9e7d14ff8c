/// @file Numbering.cc
/// Used vertices by dilation of masks, tets by masks; ids by count and scan.
#include "numbering/Numbering.h"

#include "tets/TileTets.h"

#include <tbb/enumerable_thread_specific.h>

#include <memory>

namespace vdbtet {

namespace {

/// @return the vertices of @a lattice in a tile that have a neighbour, by a short or a long edge, in the
/// interior.
TileMask nextToInterior(const PaddedMask& sameLattice, const PaddedMask& otherLattice, bcc::Lattice lattice) {
    TileMask mask;
    for (int axis = 0; axis < 3; ++axis) {
        for (int step : {-1, 1}) {
            mask |= sameLattice.shifted(axis == 0 ? step : 0, axis == 1 ? step : 0, axis == 2 ? step : 0);
        }
    }
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(lattice, d);
        mask |= otherLattice.shifted(step.x, step.y, step.z);
    }
    return mask;
}

/// Looks at one tile after another; one for each thread.
class TileNumberer {
public:
    TileNumberer(const Vertices& vertices, const Flips& flips, const Frame& frame)
        : mVertices(vertices), mFrame(frame), mTets(vertices, flips) {}

    /// @param used  receives the used vertices
    /// @return the number of tets
    std::int64_t number(TileRef tile, std::array<TileMask, 2>& used) {
        mStates.load(mVertices, tile);
        mTets.load(tile, mStates);
        ambiguous += mTets.ambiguous();
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            used[lattice] = mStates.interiorMask(lattice).core();
            const TileMask& manifold = mVertices.labels.manifold[tile][lattice];
            if (!manifold.any()) continue;
            const TileMask moved =
                manifold & nextToInterior(mStates.interiorMask(lattice),
                                          mStates.interiorMask(bcc::other(lattice)), lattice);
            used[lattice] |= moved;
            expandBounds(tile, lattice, moved);
        }
        return mTets.tets();
    }

    std::int64_t ambiguous = 0;
    openvdb::BBoxd bounds;

private:
    /// The mesh is bounded by manifold vertices alone, and its points lie in their convex hull.
    void expandBounds(TileRef tile, bcc::Lattice lattice, const TileMask& moved) {
        const openvdb::Coord& at = mVertices.layout.surfaceTiles[tile];
        const openvdb::Vec3d origin(8.0 * at.x(), 8.0 * at.y(), 8.0 * at.z());
        const TileMask& manifold = mVertices.labels.manifold[tile][lattice];
        std::int64_t move = mVertices.destinations.first[tile][lattice];
        manifold.forEach([&](int n) {
            const openvdb::Vec3d to = homeOf(localIndex(lattice, n)) + mVertices.destinations.move(move++);
            if (moved.test(n)) bounds.expand(mFrame.world(origin + to));
        });
    }

    const Vertices& mVertices;
    const Frame& mFrame;
    LocalStates mStates;
    TileTets mTets;
};

} // namespace

Numbering numberMesh(const Vertices& vertices, const Flips& flips, const Frame& frame, Interrupt& interrupt) {
    const Layout& layout = vertices.layout;
    const std::int64_t tiles = layout.surfaceCount();
    Numbering numbering;
    numbering.used.resize(tiles);
    std::vector<std::int64_t> tets(tiles);
    tbb::enumerable_thread_specific<std::unique_ptr<TileNumberer>> numberers(
        [&] { return std::make_unique<TileNumberer>(vertices, flips, frame); });
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        TileNumberer& numberer = *numberers.local();
        for (std::int64_t t = begin; t < end; ++t) tets[t] = numberer.number(TileRef(t), numbering.used[t]);
    });
    for (const auto& part : numberers) {
        numbering.ambiguous += part->ambiguous;
        numbering.bounds.expand(part->bounds);
    }

    for (auto* first : {&numbering.firstPoint, &numbering.firstTet}) {
        first->reserve(layout.spans.size() + 1);
        first->push_back(0);
    }
    for (const Layout::Span& span : layout.spans) {
        const bool interior = span.surface < 0;
        const std::int64_t points = interior ? kInteriorPoints * span.count
                                             : numbering.used[span.surface][bcc::A].count() +
                                                   numbering.used[span.surface][bcc::B].count();
        numbering.firstPoint.push_back(numbering.points() + points);
        numbering.firstTet.push_back(numbering.tets() +
                                     (interior ? kInteriorTets * span.count : tets[span.surface]));
    }
    return numbering;
}

} // namespace vdbtet
