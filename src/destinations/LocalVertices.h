/// @file LocalVertices.h
/// The vertices in and around one surface tile, unpacked for the stages that look at tets.
#pragma once

#include "bcc/Lattice.h"
#include "destinations/Destinations.h"
#include "field/Field.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// What the stages up to the destinations made.
struct Vertices {
    const Layout& layout;
    const std::vector<TileSigns>& signs;
    const Labels& labels;
    const Destinations& destinations;
};

/// The masks around a tile of the vertices inside that are not manifold.
class Interior {
public:
    Interior() = default;
    Interior(const Vertices& vertices, const Neighbours& neighbours);

    /// @return the masks of one lattice; valid as long as this object.
    MasksAround masks(int lattice) const {
        MasksAround around;
        for (int slot = 0; slot < 27; ++slot) around.masks[slot] = &mMasks[lattice][slot];
        return around;
    }

private:
    std::array<std::array<TileMask, 27>, 2> mMasks; ///< by lattice and neighbourSlot()
};

enum class State : std::uint8_t {
    Outside,
    Inside,  ///< inside and not manifold
    Manifold ///< on the surface
};

/// The number of a vertex with coordinates -1 to 8 seen from a tile; steps between vertices are differences
/// of numbers.
constexpr int localIndex(int lattice, int x, int y, int z) {
    return lattice * 1000 + (x + 1) * 100 + (y + 1) * 10 + (z + 1);
}
constexpr int localIndex(int lattice, int vertex) {
    return localIndex(lattice, vertex >> 6, vertex >> 3 & 7, vertex & 7);
}
constexpr int kLocalVertices = 2000;

using LocalOctahedron = std::array<int, 6>;

/// @return the local numbers of the octahedron of the spine that starts at @a base, a local number in @a
/// lattice.
inline LocalOctahedron localOctahedron(bcc::Lattice lattice, int axis, int base) {
    LocalOctahedron local;
    for (int v = 0; v < 6; ++v) {
        const bcc::Vertex& o = bcc::kOctahedra[lattice][axis][v];
        local[v] = base + (o.lattice - lattice) * 1000 + o.x * 100 + o.y * 10 + o.z;
    }
    return local;
}

class LocalVertices {
public:
    LocalVertices();

    /// Unpack the surroundings of surface tile @a tile.
    void load(const Vertices& vertices, TileRef tile);

    State state(int local) const { return mState[local]; }
    bool manifold(int local) const { return mState[local] == State::Manifold; }

    /// The position in lattice units, relative to L_A's lowest vertex of the tile; for manifold vertices the
    /// destination.
    const openvdb::Vec3d& position(int local) const { return mPosition[local]; }

    /// The move of a manifold vertex from its place in the lattice.
    openvdb::Vec3d move(int local) const { return mPosition[local] - home(local); }

    const Interior& interior() const { return mInterior; }
    const Neighbours& neighbours() const { return mNeighbours; }

    /// The place in the lattice.
    static openvdb::Vec3d home(int local) {
        const int lattice = local / 1000, n = local % 1000;
        const double shift = 0.5 * lattice - 1.0;
        return openvdb::Vec3d(n / 100 + shift, n / 10 % 10 + shift, n % 10 + shift);
    }

private:
    /// Make the manifold vertices of the tile at neighbourSlot() @a slot so, as far as they are at hand.
    void move(const Vertices& vertices, TileRef from, bcc::Lattice lattice, int slot);

    std::array<State, kLocalVertices> mState;
    std::array<openvdb::Vec3d, kLocalVertices> mPosition;
    Neighbours mNeighbours;
    Interior mInterior;
    std::vector<int> mMoved; ///< whose positions are not their homes
};

} // namespace vdbtet
