/// @file Field.h
/// The scalar field as the lattice sees it: where its surface may be, its signs, and its cut points.
///
/// The field phi is positive inside, as in the paper; phi >= 0 counts as inside (equation (2)). This
/// interface is where the types of grids end: all later stages are plain code.
#pragma once

#include "Parallel.h"
#include "bcc/Lattice.h"
#include "bits/PaddedMask.h"
#include "bits/TileMask.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbtet {

/// The inside vertices of a tile, L_A and L_B.
using TileSigns = std::array<TileMask, 2>;

/// For each direction the vertices of a tile that have some property along the short edge that way.
using EdgeMasks = std::array<TileMask, bcc::kDirections>;
/// The same of the vertices in and around a tile.
using PaddedEdgeMasks = std::array<PaddedMask, bcc::kDirections>;

/// A short edge from a vertex of some lattice of a tile.
struct ShortEdge {
    std::uint16_t vertex; ///< its PaddedMask::bit()
    std::uint8_t direction;
    bool halved = false; ///< its threshold is the middle, whatever that of others is
};

/// The field at some point.
struct FieldPoint {
    double phi = 0.0;
    openvdb::Vec3d gradient{0.0}; ///< by lattice units
    bool steep = false;           ///< whether the gradient can be relied on; its length alone says nothing
};

class Field {
public:
    virtual ~Field() = default;

    /// @return the tiles that the surface matters to, in ascending order. Tile (x,y,z) owns the vertices
    /// [8x, 8x+8) x [8y, 8y+8) x [8z, 8z+8) of both lattices.
    /// @details Any other tile is plain inside or plain outside: no short edge is cut that touches a vertex
    /// of an octahedron, of either lattice, whose spine's lower end the tile owns.
    /// @param margin  0; or 1, for a reach of one cell more: then no cut edge touches any vertex next to one
    /// of those octahedra's, either
    /// @throw TooLarge for more than @a maxTiles, and where the grid's coordinates end
    virtual std::vector<openvdb::Coord> surfaceTiles(std::int64_t maxTiles, int margin,
                                                     Interrupt& interrupt) const = 0;

    /// Reads the field; one for each task, since it caches.
    class Sampler {
    public:
        virtual ~Sampler() = default;

        /// @brief Decide which vertices in and around @a tile are inside.
        /// @param a  receives them for the L_A vertices at 0 to 8, by PaddedMask::bit()
        /// @param b  the same for the L_B vertices at -1 to 7: the other ends of all short edges from the
        /// tile's L_A vertices, as @a a has them of its L_B vertices
        /// @details A vertex gets the same sign from every tile. Bits farther out are arbitrary.
        virtual void signs(const openvdb::Coord& tile, PaddedMask& a, PaddedMask& b) = 0;

        /// @brief Decide which ends of cut short edges are the nearer ones to their cut points.
        /// @param edges   from L_A vertices at 0 to 8 to L_B vertices at -1 to 7 of the other sign
        /// @param tau     the end inside is the nearer one up to this fraction of an edge
        /// @param nearer  receives, beside what is there, the edges whose L_A end is the nearer one, or that
        /// are tied
        virtual void nearerToA(const openvdb::Coord& tile, const PaddedEdgeMasks& edges, double tau,
                               PaddedEdgeMasks& nearer) = 0;

        /// @brief Find cut points from their nearer ends.
        /// @param lattice   that of the nearer ends
        /// @param edges     from the tile's own vertices
        /// @param tau       as above; 1/2 of halved edges
        /// @param distance  receives for each edge the distance of its cut point as a fraction of the edge,
        /// in [0, tau] from an end inside, in [0, 1 - tau] from one outside
        virtual void cutPoints(const openvdb::Coord& tile, bcc::Lattice lattice,
                               const std::vector<ShortEdge>& edges, double tau, float* distance) = 0;

        /// @brief Find where vertices come to the surface along the gradient of the field.
        /// @param vertices  of the tile, by PaddedMask::bit()
        /// @param reach     of each, how far to look, lattice units
        /// @param offsets   receives for each vertex the way to the surface, lattice units; zero where the
        /// field does not change its sign within reach
        /// @details The gradient is estimated from the vertex's eight neighbours along short edges.
        virtual void alongGradient(const openvdb::Coord& tile, bcc::Lattice lattice,
                                   const std::vector<std::uint16_t>& vertices,
                                   const std::vector<double>& reach, openvdb::Vec3d* offsets) = 0;
    };

    virtual std::unique_ptr<Sampler> sampler() const = 0;

    /// Reads the field anywhere; one for each task, since it caches.
    class Probe {
    public:
        virtual ~Probe() = default;

        /// @return the field, the one whose cut points Sampler finds, at a point in lattice units.
        virtual FieldPoint at(const openvdb::Vec3d& place) = 0;
    };

    virtual std::unique_ptr<Probe> probe() const = 0;
};

} // namespace vdbtet
