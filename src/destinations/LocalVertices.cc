/// @file LocalVertices.cc
/// Unpacks states and positions from the masks of 27 tiles.
#include "destinations/LocalVertices.h"

namespace vdbtet {

Interior::Interior(const Vertices& vertices, const Neighbours& neighbours) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        for (int slot = 0; slot < 27; ++slot) {
            const TileRef tile = neighbours[slot];
            mMasks[lattice][slot] =
                tile >= 0 ? vertices.signs[tile][lattice] & ~vertices.labels.manifold[tile][lattice]
                          : TileMask::filled(tile == kInside);
        }
    }
}

LocalVertices::LocalVertices() {
    for (int local = 0; local < kLocalVertices; ++local) mPosition[local] = home(local);
}

void LocalVertices::load(const Vertices& vertices, TileRef tile) {
    mNeighbours = vertices.layout.neighbours(tile);
    mInterior = Interior(vertices, mNeighbours);
    for (int lattice = 0; lattice < 2; ++lattice) {
        const MasksAround inside = mInterior.masks(lattice);
        for (int x = -1; x <= 8; ++x) {
            for (int y = -1; y <= 8; ++y) {
                const unsigned in = inside.row(x, y);
                State* row = mState.data() + localIndex(lattice, x, y, -1);
                for (int z = 0; z < 10; ++z) row[z] = (in >> z & 1) ? State::Inside : State::Outside;
            }
        }
    }
    for (int local : mMoved) mPosition[local] = home(local);
    mMoved.clear();
    for (int lattice = 0; lattice < 2; ++lattice) {
        for (int slot = 0; slot < 27; ++slot) {
            if (mNeighbours[slot] >= 0) move(vertices, mNeighbours[slot], bcc::Lattice(lattice), slot);
        }
    }
}

void LocalVertices::move(const Vertices& vertices, TileRef from, bcc::Lattice lattice, int slot) {
    const int shift[3] = {8 * (slot / 9 - 1), 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1)};
    std::int64_t next = vertices.destinations.first[from][lattice];
    vertices.labels.manifold[from][lattice].forEach([&](int vertex) {
        const std::int64_t number = next++;
        const int x = (vertex >> 6) + shift[0], y = (vertex >> 3 & 7) + shift[1], z = (vertex & 7) + shift[2];
        if (x < -1 || x > 8 || y < -1 || y > 8 || z < -1 || z > 8) return;
        const int local = localIndex(lattice, x, y, z);
        mState[local] = State::Manifold;
        mPosition[local] += vertices.destinations.move(number);
        mMoved.push_back(local);
    });
}

} // namespace vdbtet
