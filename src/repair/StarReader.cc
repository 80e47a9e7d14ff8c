/// @file StarReader.cc
/// Stars from the tile that has the vertex, tets by the tile that owns them.
#include "repair/StarReader.h"

#include <algorithm>

namespace vdbtet {

StarReader::Surrounding& StarReader::surroundings(TileRef tile) {
    auto& kept = mKept[std::size_t(tile) % kKept];
    if (!kept) kept = std::make_unique<Surrounding>(mVertices, mFlips);
    if (kept->tile != tile) {
        kept->tile = tile;
        kept->vertices.load(tile);
        kept->stars.load(tile, kept->vertices);
    }
    return *kept;
}

std::int64_t StarReader::idOf(TileRef tile, int local) const {
    const int n = bitOf(local), x = PaddedMask::x(n), y = PaddedMask::y(n), z = PaddedMask::z(n);
    const TileRef owner =
        mVertices.layout.neighbours[tile][neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
    if (owner < 0) return -1;
    return VertexId::of(owner, latticeOf(local), TileMask::bit(x & 7, y & 7, z & 7));
}

void StarReader::read(std::int64_t vertex, const ToggledTets& toggled, Star& star) {
    star.tile = VertexId::tile(vertex);
    star.vertex = VertexId::local(vertex);
    star.size = 0;
    star.link.clear();
    star.in = star.ambiguous = star.inBefore = 0;
    surroundings(star.tile).stars.forEachTet(star.vertex, [&](const StarTet& tet) {
        const LinkMask bit = LinkMask(1) << star.size;
        // Tets that some other tile than a surface tile owns are never toggled, and need no id.
        const std::int64_t spine = idOf(star.tile, tet.name.lower);
        const std::int64_t id =
            spine < 0 ? -1
                      : TetId::of(VertexId::tile(spine), tetCode(tet.name.lattice, tet.name.axis,
                                                                 tet.name.number, VertexId::bit(spine)));
        const bool isToggled = std::binary_search(toggled.begin(), toggled.end(), id);
        const bool before = tet.presence == Presence::InMesh;
        if (before) star.inBefore |= bit;
        if (before != isToggled) {
            star.in |= bit;
        } else if (tet.presence == Presence::Ambiguous) {
            star.ambiguous |= bit;
        }
        star.link.add(faceOpposite(tet.vertices, star.vertex));
        star.tets[std::size_t(star.size)] = tet;
        star.ids[std::size_t(star.size)] = id;
        ++star.size;
    });
    star.link.close();
}

} // namespace vdbtet
