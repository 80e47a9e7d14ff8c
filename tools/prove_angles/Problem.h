/// @file Problem.h
/// What is to be proved, of which tets, for which parameters.
#pragma once

#include "Shapes.h"

#include <string>
#include <vector>

namespace vdbtet::proof {

/// All tets have positive volume and dihedral angles in (min,max) degrees; or, if @a radius is not 0, the
/// sphere through their corners has a smaller radius, in units of the spacing.
struct Bound {
    double min = 0.0, max = 180.0;
    double radius = 0.0;
};

/// A side condition: constant + slope.p >= 0.
struct Condition {
    Interval constant;
    Values<Interval> slope{};

    Interval on(const Box& box) const {
        Interval sum = constant;
        for (int p = 0; p < kParameters; ++p) sum += slope[p] * box[p];
        return sum;
    }
};

/// How one of several sets of tets is taken.
enum class Policy {
    Only,       ///< there is one
    Algorithm4, ///< as better() of flips/Slices.h says
    Quality     ///< the one of greater min(least angle, 0.54 (180 - greatest angle)): version 3
};

/// A family of configurations: what is proved is that at each point of the domain that meets the conditions
/// all tets of at least one alternative keep the bound.
struct Problem {
    std::string name;
    Box domain;
    std::vector<std::vector<Tet>> alternatives;
    std::vector<Condition> conditions;
    Policy policy = Policy::Only;
    int count = 1; ///< of configurations that are alike by a symmetry of the lattice
};

} // namespace vdbtet::proof
