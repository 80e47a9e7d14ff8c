/// @file LocalVertices.cc
/// Gathers states and positions from 27 tiles.
#include "destinations/LocalVertices.h"

namespace vdbtet {

namespace {

std::array<TileMask, 27> bordersOfNeighbours() {
    std::array<TileMask, 27> borders;
    for (int slot = 0; slot < 27; ++slot) {
        const int step[3] = {slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1};
        for (int n = 0; n < TileMask::kSize; ++n) {
            const int at[3] = {n >> 6, n >> 3 & 7, n & 7};
            bool near = true;
            for (int i = 0; i < 3; ++i) near = near && (step[i] == 0 || at[i] == (step[i] < 0 ? 7 : 0));
            if (near) borders[slot].set(n);
        }
    }
    return borders;
}

} // namespace

const TileMask& borderOf(int slot) {
    static const std::array<TileMask, 27> kBorders = bordersOfNeighbours();
    return kBorders[slot];
}

void LocalStates::load(const Vertices& vertices, TileRef tile) {
    const Surroundings around(vertices.layout.neighbours[tile]);
    for (int lattice = 0; lattice < 2; ++lattice) {
        mManifold[lattice] = PaddedMask(around.masks(vertices.labels.manifold, lattice));
        mInterior[lattice] = PaddedMask(around.signs(vertices.signs, lattice));
        mInterior[lattice].remove(mManifold[lattice]);
    }
}

LocalVertices::LocalVertices() {
    for (int local = 0; local < kLocalVertices; ++local) mPosition[local] = home(local);
}

void LocalVertices::load(const Vertices& vertices, TileRef tile) {
    LocalStates::load(vertices, tile);
    for (int local : mMoved) mPosition[local] = home(local);
    mMoved.clear();
    for (int lattice = 0; lattice < 2; ++lattice) {
        if (!manifoldMask(lattice).any()) continue;
        for (int slot = 0; slot < 27; ++slot) {
            const TileRef from = vertices.layout.neighbours[tile][slot];
            if (from < 0) continue;
            const int shift = localIndex(lattice, 8 * (slot / 9 - 1), 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1)) -
                              PaddedMask::bit(0, 0, 0);
            const TileMask& manifold = vertices.labels.manifold[from][lattice];
            const std::int64_t first = vertices.destinations.first[from][lattice];
            (manifold & borderOf(slot)).forEach([&](int n) {
                const int local = PaddedMask::bit(n) + shift;
                mPosition[local] += vertices.destinations.move(first + manifold.rank(n));
                mMoved.push_back(local);
            });
        }
    }
}

} // namespace vdbtet
