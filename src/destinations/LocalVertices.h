/// @file LocalVertices.h
/// The vertices in and around one surface tile, for the stages that look at tets.
#pragma once

#include "bcc/Lattice.h"
#include "bits/PaddedMask.h"
#include "destinations/Changes.h"
#include "destinations/Destinations.h"
#include "destinations/Moves.h"
#include "field/Field.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// What the stages up to the destinations made, and where the vertices are now.
struct Vertices {
    const Layout& layout;
    const std::vector<TileSigns>& signs;
    const Labels& labels;
    const Destinations& destinations;
    const Moves* moves = nullptr;     ///< in place of the destinations, or null
    const Changes* changes = nullptr; ///< of the tets, or null

    /// @return what of a tile differs from what labels and flips say, or null
    const TileChanges* changesOf(TileRef tile) const { return changes ? changes->of(tile) : nullptr; }

    /// The vertices of a surface tile that are not at home, and the number of the first one's offset.
    const TileMask& moved(TileRef tile, int lattice) const {
        return moves ? moves->moved[tile][lattice] : labels.manifold[tile][lattice];
    }
    std::int64_t firstMove(TileRef tile, int lattice) const {
        return moves ? moves->first[tile][lattice] : destinations.first[tile][lattice];
    }
    /// Offset number @a i from home, lattice units.
    openvdb::Vec3d move(std::int64_t i) const {
        return moves ? openvdb::Vec3d(moves->offsets[i]) : destinations.move(i);
    }
    bool anyMoved(TileRef tile) const { return moves ? moves->any(tile) : destinations.any(tile); }
};

enum class State : std::uint8_t {
    Outside,
    Inside,  ///< inside and not manifold
    Manifold ///< on the surface
};

/// The lattice's part of a local number; the rest is PaddedMask::bit().
constexpr int kLocalLattice = 1 << 11;
constexpr int kLocalVertices = kLocalLattice + PaddedMask::kSize;
static_assert(PaddedMask::kSize <= kLocalLattice, "the lattice's bit must be free");

/// The number of a vertex with coordinates -1 to 8 seen from a tile; steps between vertices are differences
/// of numbers.
constexpr int localIndex(int lattice, int x, int y, int z) {
    return lattice * kLocalLattice + PaddedMask::bit(x, y, z);
}
constexpr int localIndex(int lattice, int vertex) {
    return lattice * kLocalLattice + PaddedMask::bit(vertex);
}
constexpr bcc::Lattice latticeOf(int local) { return bcc::Lattice(unsigned(local) / kLocalLattice); }
constexpr int bitOf(int local) { return int(unsigned(local) % kLocalLattice); }

using LocalOctahedron = std::array<int, 6>;

/// @return the local numbers of the octahedron of the spine that starts at @a base, a local number in @a
/// lattice.
constexpr LocalOctahedron localOctahedron(bcc::Lattice lattice, int axis, int base) {
    LocalOctahedron local{};
    for (int v = 0; v < 6; ++v) {
        const bcc::Vertex& o = bcc::kOctahedra[lattice][axis][v];
        local[v] = base + (o.lattice - lattice) * kLocalLattice + PaddedMask::step(o.x, o.y, o.z);
    }
    return local;
}

/// The states of a tile's vertices and of a border of one around it.
class LocalStates {
public:
    /// @param tile  a surface tile, or kInside for one far from any
    void load(const Vertices& vertices, TileRef tile);

    /// Forget the interior of L_B but for these.
    void keepCells(const PaddedMask& cells) { mInterior[bcc::B].intersect(cells); }

    State state(int local) const {
        return interior(local) ? State::Inside : manifold(local) ? State::Manifold : State::Outside;
    }
    bool interior(int local) const { return mInterior[latticeOf(local)].test(bitOf(local)); }
    bool manifold(int local) const { return mManifold[latticeOf(local)].test(bitOf(local)); }

    /// The vertices inside that are not manifold.
    const PaddedMask& interiorMask(int lattice) const { return mInterior[lattice]; }
    const PaddedMask& manifoldMask(int lattice) const { return mManifold[lattice]; }

    /// The same of both lattices.
    const std::array<PaddedMask, 2>& interiorMasks() const { return mInterior; }
    const std::array<PaddedMask, 2>& manifoldMasks() const { return mManifold; }

private:
    std::array<PaddedMask, 2> mInterior, mManifold; ///< by lattice
};

/// The part of the neighbour at neighbourSlot() @a slot, by its own bits, that is in a tile's border.
const TileMask& borderOf(int slot);

/// @return the own surface tiles that have any of some vertices, or have them in their border; ascending.
std::vector<TileRef> tilesNear(const Layout& layout, const VertexMasks& vertices, Interrupt& interrupt);

/// The place of a vertex in the lattice, relative to L_A's lowest vertex of the tile.
inline openvdb::Vec3d homeOf(int local) {
    const double shift = 0.5 * latticeOf(local);
    const int n = bitOf(local);
    return openvdb::Vec3d(PaddedMask::x(n) + shift, PaddedMask::y(n) + shift, PaddedMask::z(n) + shift);
}

/// The same vertices, with the destinations of any of them looked up when asked for.
class LocalVertices : public LocalStates {
public:
    explicit LocalVertices(const Vertices& vertices) : mVertices(vertices) {}

    void load(TileRef tile) {
        LocalStates::load(mVertices, tile);
        mNeighbours = &mVertices.layout.neighbours[tile];
    }

    /// The number of a manifold vertex's move in Destinations.
    std::int64_t moveOf(int local) const {
        const int n = bitOf(local), x = PaddedMask::x(n), y = PaddedMask::y(n), z = PaddedMask::z(n);
        const TileRef from = (*mNeighbours)[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
        const bcc::Lattice lattice = latticeOf(local);
        const Destinations& all = mVertices.destinations;
        const std::uint64_t word = mVertices.labels.manifold[from][lattice].words[x & 7],
                            bit = std::uint64_t(1) << TileMask::bit(0, y & 7, z & 7);
        return all.first[from][lattice] + all.before[from][lattice][x & 7] + countBits(word & (bit - 1));
    }

    /// The position in lattice units, relative to L_A's lowest vertex of the tile; for manifold vertices the
    /// destination.
    openvdb::Vec3d position(int local) const {
        return manifold(local) ? homeOf(local) + mVertices.destinations.move(moveOf(local)) : homeOf(local);
    }

    const Destinations& destinations() const { return mVertices.destinations; }

private:
    const Vertices& mVertices;
    const Neighbours* mNeighbours = nullptr;
};

/// @return the vertices of @a lattice in a tile that have a neighbour, by a short or a long edge, in some
/// masks of both lattices.
TileMask nextTo(const std::array<PaddedMask, 2>& masks, bcc::Lattice lattice);

/// Where all of them are now, for those who look at each many times.
class LocalPositions {
public:
    LocalPositions();

    /// Unpack the surroundings of surface tile @a tile.
    void load(const Vertices& vertices, TileRef tile);

    /// In lattice units, relative to L_A's lowest vertex of the tile.
    const openvdb::Vec3d& operator[](int local) const { return mPosition[local]; }

    /// Put a vertex that has an offset elsewhere.
    void move(int local, const openvdb::Vec3d& to) { mPosition[local] = to; }

    /// Whether any vertex is not at home.
    bool anyMoved() const { return !mMoved.empty(); }

private:
    std::array<openvdb::Vec3d, kLocalVertices> mPosition;
    std::vector<int> mMoved;
};

} // namespace vdbtet
