/// @file CutDistances.h
/// Where many short edges are cut, for edges from the corners of voxel-centred cubes to their centres.
#pragma once

#include "field/Diagonal.h"
#include "simd/Isa.h"

#include <cstdint>

namespace vdbtet {

/// A batch of cut edges: the corner values of their cubes, each from the edge's L_A end as Diagonal::of()
/// wants them.
struct CutEdges {
    static constexpr int kLanes = 32;

    int count = 0;
    double corners[8][kLanes] = {};
    double near[kLanes] = {}; ///< the field at the end that the cut point is nearer to
    double tau[kLanes] = {};  ///< the end inside is the nearer one up to this fraction of the edge

    bool full() const { return count == kLanes; }
};

/// @return the edges, by bit, of which cutInFirstPart() is true, the first end being that of L_A.
std::uint32_t cutsInFirstPart(const CutEdges& edges, Isa isa);

/// @brief distanceToCut() of the edges.
/// @param nearIsB   whether the near ends are those of L_B
/// @param distance  receives as many numbers as there are edges
void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa);

} // namespace vdbtet
