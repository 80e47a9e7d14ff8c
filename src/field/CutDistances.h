/// @file CutDistances.h
/// Cut points of many short edges at a time.
#pragma once

#include "field/Diagonal.h"
#include "simd/Isa.h"

#include <vector>

namespace vdbtet {

/// Edges whose cut points are wanted.
struct CutEdges {
    std::vector<double> b0, b1, b2, b3; ///< of their Diagonal, from the L_A end
    std::vector<double> near;           ///< the field at the end that the cut point is nearer to

    void clear() {
        for (auto* values : {&b0, &b1, &b2, &b3, &near}) values->clear();
    }
    void add(const Diagonal& phi, double nearValue) {
        b0.push_back(phi.b0);
        b1.push_back(phi.b1);
        b2.push_back(phi.b2);
        b3.push_back(phi.b3);
        near.push_back(nearValue);
    }
    std::size_t size() const { return near.size(); }
};

/// @brief distanceToCut() of all @a edges.
/// @param nearIsB   whether the near ends are those of L_B
/// @param distance  receives as many numbers as there are edges
void distancesToCuts(const CutEdges& edges, bool nearIsB, float* distance, Isa isa);

} // namespace vdbtet
