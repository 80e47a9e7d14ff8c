/// @file VertexStep.h
/// Moves one vertex to where the worst tet at it is better.
#pragma once

#include "field/Field.h"
#include "optimize/Ball.h"

#include <openvdb/Types.h>

#include <memory>

namespace vdbtet {

/// What the steps are to reach.
struct StepGoals {
    double quality;   ///< a ball of this quality, see TetQuality.h, is left alone
    double tolerance; ///< the distance from the zero set at which a point counts as on it, lattice units
};

/// One for each task.
class VertexStep {
public:
    VertexStep(std::unique_ptr<Field::Probe> probe, const StepGoals& goals)
        : mProbe(std::move(probe)), mGoals(goals) {}

    enum class Outcome {
        Fine,  ///< the ball is good enough
        Stuck, ///< no place nearby is better
        Moved
    };

    /// @brief Look for a better place for a vertex.
    /// @param ball    its tets, complete; they are left in some order, judged where the vertex then is
    /// @param slides  whether it must stay on the zero set, where it is
    /// @param origin  where the zero of all positions lies, lattice units
    /// @param home    of the vertex
    /// @param offset  where it is relative to @a home; receives the better place
    /// @details A place is better if the worst quality in the ball is; no angle of the ball leaves [25, 140]
    /// degrees, and none that is outside gets any worse. All judged as rounded to float. Where one is still
    /// outside the vertex goes on from there, a few times.
    Outcome improve(Ball& ball, bool slides, const openvdb::Vec3d& origin, const openvdb::Vec3d& home,
                    openvdb::Vec3f& offset);

private:
    /// The ways to go, best first.
    class Directions;

    /// @brief Look for a better place, once.
    /// @param before  the ball, as it was judged where the vertex is
    /// @return whether @a offset is another one now
    bool move(Ball& ball, const BallQuality& before, bool slides, const openvdb::Vec3d& origin,
              const openvdb::Vec3d& home, openvdb::Vec3f& offset);

    /// @param normal  along which the point may go, a unit vector
    /// @return whether @a place could be brought onto the zero set.
    bool project(const openvdb::Vec3d& origin, const openvdb::Vec3d& normal, openvdb::Vec3d& place);

    std::unique_ptr<Field::Probe> mProbe;
    StepGoals mGoals;
};

} // namespace vdbtet
