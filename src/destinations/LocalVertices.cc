#include "destinations/LocalVertices.h"

namespace vdbtet {

LocalVertices::LocalVertices() {
    for (int local = 0; local < kLocalVertices; ++local) mPosition[local] = home(local);
}

void LocalVertices::load(const Vertices& vertices, TileRef tile) {
    const Neighbours& neighbours = vertices.layout.neighbours[tile];
    const Surroundings around(neighbours);
    for (int local : mMoved) mPosition[local] = home(local);
    mMoved.clear();

    for (int lattice = 0; lattice < 2; ++lattice) {
        PaddedMask& inside = mInterior[lattice];
        PaddedMask& manifold = mManifold[lattice];
        inside = around.signs(vertices.signs, lattice);
        manifold = around.masks(vertices.labels.manifold, lattice);
        inside.subtract(manifold);
        for (int x = -1; x <= 8; ++x) {
            for (int y = -1; y <= 8; ++y) {
                const unsigned in = inside.row(x, y), on = manifold.row(x, y);
                State* row = mState.data() + localIndex(lattice, x, y, -1);
                for (int z = 0; z < 10; ++z) {
                    row[z] = (on >> z & 1) ? State::Manifold : (in >> z & 1) ? State::Inside : State::Outside;
                }
            }
        }
        for (int slot = 0; slot < 27; ++slot) {
            const TileRef from = neighbours[slot];
            if (from < 0) continue;
            const int shift[3] = {8 * (slot / 9 - 1), 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1)};
            const openvdb::Vec3f* move =
                vertices.destinations.moves.data() + vertices.destinations.first[from][lattice];
            vertices.labels.manifold[from][lattice].forEach([&](int vertex) {
                const openvdb::Vec3f& by = *move++;
                const int x = (vertex >> 6) + shift[0], y = (vertex >> 3 & 7) + shift[1],
                          z = (vertex & 7) + shift[2];
                if (x < -1 || x > 8 || y < -1 || y > 8 || z < -1 || z > 8) return;
                const int local = localIndex(lattice, x, y, z);
                mPosition[local] += openvdb::Vec3d(by);
                mMoved.push_back(local);
            });
        }
    }
}

} // namespace vdbtet
