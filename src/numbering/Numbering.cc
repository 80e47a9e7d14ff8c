/// @file Numbering.cc
/// Used vertices by dilation of masks, ids by count and scan.
#include "numbering/Numbering.h"

namespace vdbtet {

namespace {

/// @return the vertices of @a lattice in a tile that have a neighbour, by a short or a long edge, in the
/// interior.
TileMask nextToInterior(const PaddedMask& sameLattice, const PaddedMask& otherLattice,
                        bcc::Lattice lattice) {
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

} // namespace

Numbering numberVertices(const Vertices& vertices, Interrupt& interrupt) {
    const Layout& layout = vertices.layout;
    const auto& manifold = vertices.labels.manifold;
    const std::int64_t tiles = layout.surfaceCount();

    Numbering numbering;
    numbering.used.resize(tiles);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        LocalStates states;
        for (std::int64_t t = begin; t < end; ++t) {
            for (int lattice = 0; lattice < 2; ++lattice) {
                numbering.used[t][lattice] = vertices.signs[t][lattice] & ~manifold[t][lattice];
            }
            if (!manifold[t][bcc::A].any() && !manifold[t][bcc::B].any()) continue;
            states.load(vertices, TileRef(t));
            for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
                numbering.used[t][lattice] |=
                    manifold[t][lattice] &
                    nextToInterior(states.interiorMask(lattice),
                                   states.interiorMask(bcc::other(lattice)), lattice);
            }
        }
    });

    numbering.first.reserve(layout.spans.size() + 1);
    numbering.first.push_back(0);
    for (const Layout::Span& span : layout.spans) {
        const std::int64_t points = span.surface < 0 ? kInteriorPoints * span.count
                                                     : numbering.used[span.surface][bcc::A].count() +
                                                           numbering.used[span.surface][bcc::B].count();
        numbering.first.push_back(numbering.first.back() + points);
    }
    return numbering;
}

} // namespace vdbtet
