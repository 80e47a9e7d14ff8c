/// @file Lattice.h
/// Facts of the body-centred cubic lattice (paper, section 2.1): short edges, octahedra and their slices.
///
/// Vertex (i,j,k) of L_A lies at (i,j,k), of L_B at (i+1/2, j+1/2, k+1/2), in units of the spacing c.
#pragma once

#include <array>

namespace vdbtet::bcc {

enum Lattice { A = 0, B = 1 };

constexpr Lattice other(Lattice lattice) { return lattice == A ? B : A; }

struct Step {
    int x, y, z;
};

/// A short edge leaves a vertex in one of 8 directions, numbered 4 (x>0) + 2 (y>0) + (z>0).
constexpr int kDirections = 8;

constexpr int opposite(int direction) { return 7 - direction; }

/// The sign (-1 or 1) of the component @a axis of @a direction.
constexpr int sign(int direction, int axis) { return (direction >> (2 - axis) & 1) ? 1 : -1; }

/// @return the step of integer coordinates from a vertex of lattice @a from along @a direction to its
/// neighbour in the other lattice.
constexpr Step shortEdge(Lattice from, int direction) {
    // From A the neighbour B(i) lies at +1/2 and B(i-1) at -1/2; from B, A(i+1) lies at +1/2 and A(i) at
    // -1/2.
    auto component = [=](int axis) { return (sign(direction, axis) + 1) / 2 - (from == A ? 1 : 0); };
    return {component(0), component(1), component(2)};
}

/// The short edge in each direction as a vector, in units of the spacing.
constexpr double kShortEdges[kDirections][3] = {{-0.5, -0.5, -0.5}, {-0.5, -0.5, 0.5}, {-0.5, 0.5, -0.5},
                                                {-0.5, 0.5, 0.5},   {0.5, -0.5, -0.5}, {0.5, -0.5, 0.5},
                                                {0.5, 0.5, -0.5},   {0.5, 0.5, 0.5}};

/// A vertex by lattice and integer coordinates, relative to some base vertex.
struct Vertex {
    Lattice lattice;
    int x, y, z;
};

/// The six vertices of an octahedron in the paper's order (Figure 8): v1 and v2 are the ends of the spine, v3
/// to v6 its ring, counter-clockwise about v1 -> v2.
using Octahedron = std::array<Vertex, 6>;

/// @return the octahedron of the spine from vertex (0,0,0) of @a lattice along the positive @a axis.
/// @details Along +x, relative to v1: v2 = (1,0,0), ring (1/2) (1,1,-1), (1,1,1), (1,-1,1), (1,-1,-1). The
/// other axes follow by cyclic permutation, which keeps the orientation.
constexpr Octahedron octahedron(Lattice lattice, int axis) {
    constexpr int kRingY[4] = {1, 1, -1, -1};
    constexpr int kRingZ[4] = {-1, 1, 1, -1};
    auto place = [axis](Lattice l, int u, int v, int w) {
        const int p[3] = {u, v, w};
        return Vertex{l, p[(3 - axis) % 3], p[(4 - axis) % 3], p[(5 - axis) % 3]};
    };
    Octahedron o{};
    o[0] = place(lattice, 0, 0, 0);
    o[1] = place(lattice, 1, 0, 0);
    for (int r = 0; r < 4; ++r) {
        // Half steps to integer coordinates of the other lattice, as in shortEdge().
        const int floor = lattice == A ? 1 : 0;
        o[2 + r] = place(other(lattice), 1 - floor, (kRingY[r] + 1) / 2 - floor, (kRingZ[r] + 1) / 2 - floor);
    }
    return o;
}

constexpr std::array<std::array<Octahedron, 3>, 2> kOctahedra = {
    {{octahedron(A, 0), octahedron(A, 1), octahedron(A, 2)},
     {octahedron(B, 0), octahedron(B, 1), octahedron(B, 2)}}};

/// The three ways to cut an octahedron into four tets: along its spine, or along a diagonal of its ring.
enum Slice { S = 0, SliceA = 1, SliceB = 2 };

/// The tets of each slice as numbers of the octahedron's vertices (0 is v1): the paper's equation (9). In
/// slices A and B the first two tets hold v2, the last two v1.
constexpr int kSliceTets[3][4][4] = {
    {{0, 2, 1, 5}, {0, 3, 1, 2}, {0, 4, 1, 3}, {0, 5, 1, 4}},
    {{2, 3, 4, 1}, {2, 4, 5, 1}, {2, 4, 3, 0}, {2, 5, 4, 0}},
    {{5, 2, 3, 1}, {5, 3, 4, 1}, {5, 3, 2, 0}, {5, 4, 3, 0}},
};

/// The faces of a positive tet opposite to each of its vertices, counter-clockwise from outside.
constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// A long edge of the ring: its lower end as a number of the octahedron's vertices, and its axis as an offset
/// to the spine's.
struct RingEdge {
    int lower;
    int axisOffset;
};

/// The ring edge that each tet of slice S holds, in the order of kSliceTets[S].
constexpr RingEdge kRingEdges[4] = {{5, 1}, {2, 2}, {4, 1}, {5, 2}};

} // namespace vdbtet::bcc
