/// @file TigerProblems.h
/// The paper's statements, as problems.
#pragma once

#include "Problem.h"

namespace vdbtet::proof {

/// The longest move, as a fraction of a short edge.
constexpr double kLongestMove = 0.5;

/// @name The paper's statements, as problems
///@{
std::vector<Problem> tetProblems(bool withFigures);   ///< equations (21) and (22)
std::vector<Problem> activeProblems();                ///< (24)
std::vector<Problem> flippedProblems(bool bestSlice); ///< (28)
std::vector<Problem> shortMoveProblems();             ///< (29)
std::vector<Problem> sphereProblems();                ///< (13)
std::vector<Problem> lastResortProblems();            ///< section 6.2.2
///@}

} // namespace vdbtet::proof
