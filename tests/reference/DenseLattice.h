/// @file DenseLattice.h
/// A box of the BCC lattice, every vertex with its sign and every cut short edge with its cut point (paper,
/// sections 2.1 to 2.4).
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdbtet::test {

using openvdb::Vec3d;

/// A scalar function of lattice coordinates, >= 0 inside. L_A is the integer points.
using Phi = std::function<double(const Vec3d&)>;

/// A vertex in doubled lattice coordinates: all even in L_A, all odd in L_B.
using LatticePoint = openvdb::Vec3i;

/// A vertex by its place in the dense arrays, in which the points of neither lattice stay unused.
using Vertex = std::size_t;

constexpr int kDirections = 8;

/// The short edge directions by number: 4, 2 and 1 stand for +x, +y and +z.
inline LatticePoint directionVector(int d) { return {d & 4 ? 1 : -1, d & 2 ? 1 : -1, d & 1 ? 1 : -1}; }
inline int directionNumber(const LatticePoint& v) { return 4 * (v[0] > 0) + 2 * (v[1] > 0) + (v[2] > 0); }
inline int opposite(int d) { return 7 - d; }

class DenseLattice {
public:
    /// @param box  L_A points, inclusive. The two outermost layers must be outside.
    /// @param tau  where the threshold of an edge may be but in the middle, from its end inside
    DenseLattice(const openvdb::CoordBBox& box, const Phi& phi, double tau = 0.5);

    std::size_t size() const { return mInside.size(); }
    bool holds(const LatticePoint& p) const;
    Vertex vertex(const LatticePoint& p) const;
    LatticePoint point(Vertex v) const;
    Vertex neighbour(Vertex v, int direction) const;

    const std::vector<Vertex>& verticesA() const { return mA; }
    const std::vector<Vertex>& verticesB() const { return mB; }

    bool inside(Vertex v) const { return mInside[v]; }
    /// Distance from v to the cut point of a short edge, in short edges; infinite where it is not cut (eq.
    /// 3).
    double cutDistance(Vertex v, int direction) const { return mCut[v][direction]; }
    bool isCut(Vertex v, int direction) const { return mCut[v][direction] <= 1; }

    /// Cut edges on whose nearer half, or on all of which where tau is not 1/2, phi changes its sign more
    /// than once, so that the cut point is a matter of choice. One in the half whose ends differ in sign is
    /// always chosen.
    std::int64_t manyRoots = 0;
    /// Cut edges cut in the middle, so that the nearer end is a matter of choice, and those that might be.
    std::int64_t halfTies = 0, nearHalfTies = 0;

private:
    void cutEdge(Vertex a, int direction, const Phi& phi, double tau);

    LatticePoint mOrigin;
    std::array<std::size_t, 3> mCount;
    std::vector<Vertex> mA, mB;
    std::vector<bool> mInside;
    std::vector<std::array<double, kDirections>> mCut;
};

} // namespace vdbtet::test
