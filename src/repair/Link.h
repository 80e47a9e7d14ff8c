/// @file Link.h
/// The link of a vertex: the triangles opposite to it in the tets of its star, which tile a sphere. What of
/// them is in the mesh tells whether the mesh is a manifold there.
#pragma once

#include <array>
#include <cstdint>

namespace vdbtet {

/// Some of the triangles of a link, by number.
using LinkMask = std::uint64_t;

class Link {
public:
    /// An octahedron that is flipped onto a vertex adds two tets to the lattice's 24, and there is room
    /// for 12.
    static constexpr int kMostTriangles = 48;
    static constexpr int kMostVertices = 26;

    Link() { clear(); }
    void clear() {
        mTriangles = mVertices = 0;
        mSlots.fill(-1);
    }

    /// Add a triangle, counter-clockwise seen from outside or, of all of them, from inside.
    /// @param vertices  any numbers that tell vertices apart
    void add(const std::array<int, 3>& vertices);

    /// Find who is whose neighbour, when all triangles are there.
    void close();

    int triangles() const { return mTriangles; }
    LinkMask all() const { return (LinkMask(1) << mTriangles) - 1; }
    int vertices() const { return mVertices; }
    /// As add() had it.
    int name(int vertex) const { return mNames[vertex]; }
    /// @return the number here of a vertex, or -1
    int find(int name) const;
    /// Corner @a side of a triangle, which edge @a side starts at.
    int corner(int triangle, int side) const { return mCorners[triangle][side]; }
    /// The triangle beyond an edge.
    int beyond(int triangle, int side) const { return mBeyond[triangle][side]; }
    /// The corner of a triangle that is none of its neighbour's.
    int otherCorner(int triangle, int neighbour) const {
        int side = 0;
        while (mBeyond[triangle][side] != neighbour) ++side;
        return mCorners[triangle][(side + 2) % 3];
    }
    /// The triangles at a vertex.
    LinkMask at(int vertex) const { return mAt[vertex]; }

    /// @return those of @a among that are joined to triangle @a from through edges within @a among.
    LinkMask joined(int from, LinkMask among) const;
    /// The same through edges at @a vertex alone.
    LinkMask joinedAround(int vertex, int from, LinkMask among) const;

    /// @brief How far a part of the link is from a single disc, or from all of the sphere, or from nothing:
    /// then it is 0.
    /// @details One for each fan too many, for each wedge too many about a link vertex, and, for each fan,
    /// how far it is from a disc where wedges are taken as apart. A fan is a class of triangles joined
    /// through edges, a wedge of those about a vertex.
    int badness(LinkMask in) const;

    /// @return the Euler characteristic of a fan, counting a vertex once for each of its wedges: 1 for a
    /// disc, less for one with holes.
    int euler(LinkMask fan) const;

    /// @return how many wedges of @a in are about a vertex, where not all are; else 0.
    int wedges(int vertex, LinkMask in) const;

private:
    int mTriangles = 0, mVertices = 0;
    std::array<std::array<std::uint8_t, 3>, kMostTriangles> mCorners;
    std::array<std::array<std::uint8_t, 3>, kMostTriangles> mBeyond; ///< the edge from corner i to the next
    std::array<int, kMostVertices> mNames;
    std::array<std::int8_t, 64> mSlots; ///< vertices by a hash of their names, or -1
    std::size_t slotOf(int name) const;
    std::array<LinkMask, kMostVertices> mAt;
};

} // namespace vdbtet
