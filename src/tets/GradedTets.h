/// @file GradedTets.h
/// The tets between octants (Labelle and Shewchuk's background grid, the paper's section 8.1), all tables of
/// them in the frame of the octant's face.
#pragma once

#include "bcc/Lattice.h"
#include "grading/LocalOctants.h"

#include <array>

namespace vdbtet {

/// The shapes of tets between octants.
enum class TetKind { Lattice, Bisected, Quadrisected, HalfPyramid };
constexpr int kTetKinds = 4;

/// The dihedral angles of each kind, in degrees.
constexpr std::array<std::array<int, 6>, kTetKinds> kAnglesOfKind = {{{60, 60, 60, 60, 90, 90},
                                                                      {45, 60, 60, 90, 90, 90},
                                                                      {45, 45, 60, 90, 90, 90},
                                                                      {45, 45, 60, 60, 90, 120}}};

namespace graded {

constexpr int kAlong[3] = {unitPoint(1, 0, 0), unitPoint(0, 1, 0), unitPoint(0, 0, 1)};
constexpr int kBitAlong[3] = {PaddedMask::step(1, 0, 0), PaddedMask::step(0, 1, 0),
                              PaddedMask::step(0, 0, 1)};

/// A face of an octant across an axis. All points are unitPoint()s, but for centres of level 0.
struct Face {
    int ring[4]; ///< corners, counter-clockwise about the axis from the lowest
    int axis;
    int parity; ///< of the octant
};

constexpr Face faceAt(int lowest, int axis, int edge, int parity) {
    const int u = edge * kAlong[(axis + 1) % 3], v = edge * kAlong[(axis + 2) % 3];
    return {{lowest, lowest + u, lowest + u + v, lowest + v}, axis, parity};
}

/// @brief The two tets from the centre of an octant to a face beyond which there is none of its level.
/// @details The coarser octant there has the face as a quarter of one of its own, and cuts it along the
/// diagonal through its own face's centre: that joins corners whose coordinates have an even sum.
template <typename Visit>
void visitHalfPyramids(const Face& face, bool upper, int centre, Visit&& visit) {
    const auto corner = [&](int i) { return face.ring[(face.parity + i) % 4]; };
    for (int half = 0; half < 2; ++half) {
        const int second = corner(1 + half), third = corner(2 + half);
        visit(TetKind::HalfPyramid, centre, corner(0), upper ? second : third, upper ? third : second);
    }
}

/// @return where all four children exist at the face across @a axis of an octant: by the lowest of the four.
inline PaddedMask fullQuarters(const PaddedMask& children, int axis) {
    const int u = kBitAlong[(axis + 1) % 3], v = kBitAlong[(axis + 2) % 3];
    PaddedMask halves = children, quarters;
    halves.intersect(children.movedDown(u));
    quarters = halves;
    quarters.intersect(halves.movedDown(v));
    return quarters;
}

/// The tets of the centres of two octants of @a level >= 1 that share a face.
/// @param x,y,z  the lower octant
template <typename Visit>
void visitPair(const LocalOctants& octants, int level, int x, int y, int z, const Face& face, int centre,
               Visit&& visit) {
    const int axis = face.axis, half = 1 << (level - 1);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int beyond = centre + 2 * half * kAlong[axis];
    const bool lower = octants.inside(centre), upper = octants.inside(beyond);
    if (!lower && !upper) return;

    // In the next finer level: the children at the face, on its near and on its far side, and its vertices.
    const PaddedMask& children = octants.exists(level - 1);
    const PaddedMask& vertices = octants.corners(level - 1);
    const int near = PaddedMask::bit(2 * x, 2 * y, 2 * z) + kBitAlong[axis], far = near + kBitAlong[axis];
    const int bitU = kBitAlong[u], bitV = kBitAlong[v];
    const int quarter[4] = {0, bitU, bitU + bitV, bitV};
    const int middleBit[4] = {bitU, 2 * bitU + bitV, bitU + 2 * bitV, bitV};
    const int middle[4] = {face.ring[0] + half * kAlong[u], face.ring[1] + half * kAlong[v],
                           face.ring[3] + half * kAlong[u], face.ring[0] + half * kAlong[v]};
    const bool hasCentre = vertices.test(far + bitU + bitV);
    const int faceCentre = middle[0] + half * kAlong[v];

    for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        const int p0 = face.ring[i], p1 = face.ring[next], m = middle[i];
        const bool hasMiddle = vertices.test(far + middleBit[i]);
        if (!hasCentre && !hasMiddle) {
            visit(TetKind::Lattice, centre, beyond, p0, p1);
        } else if (!hasCentre) {
            visit(TetKind::Bisected, centre, beyond, p0, m);
            visit(TetKind::Bisected, centre, beyond, m, p1);
        } else if (!hasMiddle) {
            if (lower) visit(TetKind::Bisected, centre, faceCentre, p0, p1);
            if (upper) visit(TetKind::Bisected, faceCentre, beyond, p0, p1);
        } else {
            if (lower && !children.test(near + quarter[i]))
                visit(TetKind::Quadrisected, centre, faceCentre, p0, m);
            if (lower && !children.test(near + quarter[next]))
                visit(TetKind::Quadrisected, centre, faceCentre, m, p1);
            if (upper && !children.test(far + quarter[i]))
                visit(TetKind::Quadrisected, faceCentre, beyond, p0, m);
            if (upper && !children.test(far + quarter[next]))
                visit(TetKind::Quadrisected, faceCentre, beyond, m, p1);
        }
    }
}

} // namespace graded

/// @brief Call @a visit(kind, a, b, c, d) for each tet inside whose coarsest octant is of @a level >= 1 and
/// that a tile owns: a pair of octants belongs to the lower one.
/// @param visit  gets vertices as unitPoint()s
/// @details All tets at the centre of such an octant have its sign.
template <typename Visit>
void forEachTetOfLevel(const LocalOctants& octants, int level, Visit&& visit) {
    using namespace graded;
    const int dim = TileMask::kDim >> level, edge = 1 << level, half = edge / 2;
    const PaddedMask& exists = octants.exists(level);
    const PaddedMask& children = octants.exists(level - 1);
    const PaddedMask full[3] = {fullQuarters(children, 0), fullQuarters(children, 1),
                                fullQuarters(children, 2)};
    for (int x = 0; x < dim; ++x) {
        for (int y = 0; y < dim; ++y) {
            for (int z = 0; z < dim; ++z) {
                const int bit = PaddedMask::bit(x, y, z);
                if (!exists.test(bit)) continue;
                const int lowest = unitPoint(edge * x, edge * y, edge * z);
                const int centre = lowest + half * unitPoint(1, 1, 1);
                for (int axis = 0; axis < 3; ++axis) {
                    const int parity = octants.parity(level, axis, x, y, z);
                    const int near = PaddedMask::bit(2 * x, 2 * y, 2 * z) + kBitAlong[axis];
                    // Between two octants whose children at the face all exist there is nothing.
                    if (!full[axis].test(near) || !full[axis].test(near + kBitAlong[axis])) {
                        const Face upper = faceAt(lowest + edge * kAlong[axis], axis, edge, parity);
                        if (exists.test(bit + kBitAlong[axis])) {
                            visitPair(octants, level, x, y, z, upper, centre, visit);
                        } else if (octants.inside(centre)) {
                            visitHalfPyramids(upper, true, centre, visit);
                        }
                    }
                    if (!exists.test(bit - kBitAlong[axis]) && octants.inside(centre))
                        visitHalfPyramids(faceAt(lowest, axis, edge, parity), false, centre, visit);
                }
            }
        }
    }
}

/// @brief Call @a visit(kind, a, b, c, d) for each half-pyramid at level 0.
/// @param inside  the L_B vertices inside that are not manifold
/// @param visit   gets @a a as the bit of an L_B vertex, the others as unitPoint()s of L_A
template <typename Visit>
void forEachTetOfFringe(const LocalOctants& octants, const TileMask& inside, Visit&& visit) {
    using namespace graded;
    const PaddedMask& exists = octants.exists(0);
    const TileMask cells = exists.core() & inside;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const int step[3] = {axis == 0, axis == 1, axis == 2};
            const int sign = upper ? 1 : -1;
            const TileMask fringe = cells & ~exists.shifted(sign * step[0], sign * step[1], sign * step[2]);
            fringe.forEach([&](int n) {
                const int x = n >> 6, y = n >> 3 & 7, z = n & 7;
                const int lowest = unitPoint(x, y, z) + (upper ? kAlong[axis] : 0);
                visitHalfPyramids(faceAt(lowest, axis, 1, octants.parity(0, axis, x, y, z)), upper, n, visit);
            });
        }
    }
}

} // namespace vdbtet
