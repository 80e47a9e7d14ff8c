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

std::vector<TileRef> tilesNear(const Layout& layout, const VertexMasks& vertices, Interrupt& interrupt) {
    const std::int64_t all = layout.surfaceCount(), count = layout.ownCount();
    std::vector<char> any(all), near(count);
    parallelRanges(all, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) any[t] = vertices[t][0].any() || vertices[t][1].any();
    });
    parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            for (int slot = 0; slot < 27 && !near[t]; ++slot) {
                const TileRef from = layout.neighbours[t][slot];
                near[t] = from >= 0 && any[from] &&
                          ((vertices[from][0] | vertices[from][1]) & borderOf(slot)).any();
            }
        }
    });
    std::vector<TileRef> tiles;
    for (std::int64_t t = 0; t < count; ++t) {
        if (near[t]) tiles.push_back(TileRef(t));
    }
    return tiles;
}

void LocalStates::load(const Vertices& vertices, TileRef tile) {
    if (tile == kInside) {
        mManifold.fill(PaddedMask());
        mInterior.fill(PaddedMask::filled());
        return;
    }
    const Surroundings around(vertices.layout.neighbours[tile]);
    for (int lattice = 0; lattice < 2; ++lattice) {
        mManifold[lattice] = PaddedMask(around.masks(vertices.labels.manifold, lattice));
        mInterior[lattice] = PaddedMask(around.signs(vertices.signs, lattice));
        mInterior[lattice].remove(mManifold[lattice]);
    }
}

TileMask nextTo(const std::array<PaddedMask, 2>& masks, bcc::Lattice lattice) {
    const PaddedMask &same = masks[lattice], &other = masks[bcc::other(lattice)];
    TileMask mask;
    for (const int step : {-1, 1})
        mask |= same.shifted(step, 0, 0) | same.shifted(0, step, 0) | same.shifted(0, 0, step);
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(lattice, d);
        mask |= other.shifted(step.x, step.y, step.z);
    }
    return mask;
}

LocalPositions::LocalPositions() {
    for (int local = 0; local < kLocalVertices; ++local) mPosition[local] = homeOf(local);
}

void LocalPositions::load(const Vertices& vertices, TileRef tile) {
    for (int local : mMoved) mPosition[local] = homeOf(local);
    mMoved.clear();
    const Neighbours& neighbours = vertices.layout.neighbours[tile];
    for (int slot = 0; slot < 27; ++slot) {
        const TileRef from = neighbours[slot];
        if (from < 0 || !vertices.anyMoved(from)) continue;
        const int dx = slot / 9 - 1;
        const int shift = PaddedMask::step(8 * dx, 8 * (slot / 3 % 3 - 1), 8 * (slot % 3 - 1));
        const int firstWord = dx < 0 ? 7 : 0, lastWord = dx > 0 ? 0 : 7;
        const TileMask& border = borderOf(slot);
        for (int lattice = 0; lattice < 2; ++lattice) {
            const TileMask& moved = vertices.moved(from, lattice);
            std::int64_t before = vertices.firstMove(from, lattice) + moved.rank(firstWord << 6);
            for (int w = firstWord; w <= lastWord; ++w) {
                const std::uint64_t all = moved.words[w];
                for (std::uint64_t word = all & border.words[w]; word != 0; word &= word - 1) {
                    const int bit = lowestBit(word);
                    const int local = localIndex(lattice, w << 6 | bit) + shift;
                    mPosition[local] +=
                        vertices.move(before + countBits(all & ((std::uint64_t(1) << bit) - 1)));
                    mMoved.push_back(local);
                }
                before += countBits(all);
            }
        }
    }
}

} // namespace vdbtet
