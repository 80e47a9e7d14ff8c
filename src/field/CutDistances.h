/// @file CutDistances.h
/// Where many short edges are cut, for edges from the corners of voxel-centred cubes to their centres.
#pragma once

#include "field/Diagonal.h"
#include "simd/Isa.h"

namespace vdbtet {

/// A batch of cut edges, each as its Diagonal from its L_A end.
struct CutEdges {
    static constexpr int kLanes = 32;

    int count = 0;
    double b0[kLanes] = {}, b1[kLanes] = {}, b2[kLanes] = {}, b3[kLanes] = {};
    double near[kLanes] = {}; ///< the field at the end that the cut point is nearer to
    double tau[kLanes] = {};  ///< the end inside is the nearer one up to this fraction of the edge

    void add(const Diagonal& phi, double nearValue, double ownTau) {
        b0[count] = phi.b0;
        b1[count] = phi.b1;
        b2[count] = phi.b2;
        b3[count] = phi.b3;
        near[count] = nearValue;
        tau[count++] = ownTau;
    }
    bool full() const { return count == kLanes; }
};

/// @brief distanceToCut() of the edges.
/// @param nearIsB   whether the near ends are those of L_B
/// @param distance  receives as many numbers as there are edges
void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa);

} // namespace vdbtet
