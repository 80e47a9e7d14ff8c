/// @file StarReader.h
/// Reads the stars of vertices anywhere in the mesh, one after another, while it is being repaired.
#pragma once

#include "destinations/Changes.h"
#include "repair/BoundaryCheck.h"
#include "repair/Link.h"
#include "tets/Stars.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbtet {

/// A tet, in a number that sorts by the tile that owns it, then as there.
struct TetId {
    static constexpr std::int64_t of(TileRef tile, TetCode code) { return std::int64_t(tile) << 16 | code; }
    static constexpr TileRef tile(std::int64_t id) { return TileRef(id >> 16); }
    static constexpr TetCode code(std::int64_t id) { return TetCode(id & 0xffff); }
};

/// The tets whose presence is not what labels and flips say, ascending.
using ToggledTets = std::vector<std::int64_t>;

/// All tets at a vertex, and its link, whose triangles have the tets' numbers.
struct Star {
    TileRef tile; ///< in which the vertex is, and from which all local numbers are seen
    int vertex;   ///< its local number
    int size;
    std::array<StarTet, Link::kMostTriangles> tets;
    std::array<std::int64_t, Link::kMostTriangles> ids; ///< TetId
    Link link;                                          ///< by local numbers
    LinkMask in, ambiguous; ///< in the mesh; not in it, but of four manifold vertices
    LinkMask inBefore;      ///< in the mesh where nothing is toggled

    /// @return the tet of that id, or -1
    int find(std::int64_t id) const {
        for (int t = 0; t < size; ++t) {
            if (ids[t] == id) return t;
        }
        return -1;
    }
};

/// One for each thread.
class StarReader {
public:
    StarReader(const Vertices& vertices, const Flips& flips) : mVertices(vertices), mFlips(flips) {}

    /// Read the star of a vertex, a VertexId.
    void read(std::int64_t vertex, const ToggledTets& toggled, Star& star);

    /// @return the VertexId of a local number of a tile, or -1 where no surface tile has it.
    std::int64_t idOf(TileRef tile, int local) const;

    /// Where a vertex of a star is, in lattice units, from the star's tile.
    openvdb::Vec3d position(const Star& star, int local) {
        return surroundings(star.tile).vertices.position(local);
    }

private:
    struct Surrounding {
        Surrounding(const Vertices& all, const Flips& flips) : vertices(all), stars(all, flips) {}
        TileRef tile = kOutside;
        LocalVertices vertices;
        Stars stars;
    };
    Surrounding& surroundings(TileRef tile);

    /// Stars are read a neighbourhood at a time.
    static constexpr std::size_t kKept = 64;

    const Vertices& mVertices;
    const Flips& mFlips;
    std::array<std::unique_ptr<Surrounding>, kKept> mKept;
};

} // namespace vdbtet
