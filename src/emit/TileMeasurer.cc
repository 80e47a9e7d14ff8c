/// @file TileMeasurer.cc
/// Angles of the tets that the surface moved; the others are the lattice's.
#include "emit/TileMeasurer.h"

namespace vdbtet {

void TileMeasurer::measure(TileRef tile, const TileTets& tets) {
    mPositions.load(mVertices, tile);
    if (mVertices.moves) {
        const Surroundings around(mVertices.layout.neighbours[tile]);
        for (int lattice = 0; lattice < 2; ++lattice)
            mMoved[lattice] = PaddedMask(around.masks(mVertices.moves->moved, lattice));
    }
    if (mPositions.anyMoved()) {
        addAngles(tets);
    } else {
        mSum.addLatticeTets(tets.tets());
    }
}

TileMask TileMeasurer::moved(const TileTets& tets, int axis, int vertex) const {
    if (!mVertices.moves) return tets.manifold(axis, vertex);
    const bcc::Vertex& at = bcc::kOctahedra[bcc::A][axis][vertex];
    return mMoved[at.lattice].shifted(at.x, at.y, at.z);
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
            TileMask some = moved(tets, axis, tet[0]);
            for (int i = 1; i < 4; ++i) some |= moved(tets, axis, tet[i]);
            some &= all;
            mSum.addLatticeTets(all.count() - some.count());
            const LocalOctahedron o = localOctahedron(bcc::A, axis, 0);
            some.forEach([&](int n) {
                const int base = localIndex(bcc::A, n);
                add(base + o[tet[0]], base + o[tet[1]], base + o[tet[2]], base + o[tet[3]]);
            });
        }
        tets.flippedSpines(axis).forEach([&](int n) { tets.forEachTetOf(axis, n, addFlipped); });
    }
    tets.forEachTetOfB(addFlipped);
}

} // namespace vdbtet
