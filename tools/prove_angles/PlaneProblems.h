/// @file PlaneProblems.h
/// Version 3 of the method where the surface is a plane, at least nearby.
///
/// Then the field is the height over the plane, up to a factor, and what the labelling does is known in
/// closed form. Let n be normal to the plane, m = (|n1| + |n2| + |n3|) / 2 the greatest difference of heights
/// along a short edge, and h the height of a vertex, negative inside. With arrows that leave the end inside
/// if that is nearer than the fraction tau of the edge, the manifold vertices are those of -tau m < h < (1 -
/// tau) m: from each of them the short edge that is steepest leads to a vertex that is none, and between the
/// others no short edge is cut. They move along the normal, onto the plane.
#pragma once

#include "Problem.h"

namespace vdbtet::proof {

/// @brief All tets of slice S that can be in the mesh, over all planes.
/// @details Normals need only be those of (1,u,v) with 0 <= v <= u <= 1: the 48 symmetries of the lattice
/// take any normal to one of them, and all orientations of tets are looked at. The third parameter is the
/// height of the tet's first corner.
std::vector<Problem> planeTetProblems(double tau);

/// All octahedra whose spine joins a vertex inside and one outside, neither being manifold; the ring is.
std::vector<Problem> planeOctahedronProblems(double tau);

} // namespace vdbtet::proof
