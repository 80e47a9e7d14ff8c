/// @file TileMeasurer.cc
/// Angles of the tets that the surface moved; the others are the lattice's.
#include "emit/TileMeasurer.h"

namespace vdbtet {

void TileMeasurer::measure(TileRef tile, const TileTets& tets) {
    mPositions.load(mVertices, tile);
    if (mPositions.anyMoved()) {
        addAngles(tets);
    } else {
        mSum.addLatticeTets(tets.tets());
    }
}

void TileMeasurer::addAngles(const TileTets& tets) {
    const auto add = [&](int a, int b, int c, int d) {
        mSum.add(mPositions[a], mPositions[b], mPositions[c], mPositions[d]);
    };
    const auto addFlipped = [&](const LocalTet& tet) {
        add(tet.vertex(0), tet.vertex(1), tet.vertex(2), tet.vertex(3));
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (int number = 0; number < 4; ++number) {
            const auto& tet = bcc::kSliceTets[bcc::S][number];
            const TileMask& all = tets.latticeTets(axis, number);
            TileMask moved = tets.manifold(axis, tet[0]);
            for (int i = 1; i < 4; ++i) moved |= tets.manifold(axis, tet[i]);
            moved &= all;
            mSum.addLatticeTets(all.count() - moved.count());
            const LocalOctahedron o = localOctahedron(bcc::A, axis, 0);
            moved.forEach([&](int n) {
                const int base = localIndex(bcc::A, n);
                add(base + o[tet[0]], base + o[tet[1]], base + o[tet[2]], base + o[tet[3]]);
            });
        }
        tets.flippedSpines(axis).forEach([&](int n) { tets.forEachTetOf(axis, n, addFlipped); });
    }
    tets.forEachTetOfB(addFlipped);
}

} // namespace vdbtet
