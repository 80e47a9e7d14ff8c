/// @file TetShapes.h
/// Where the tets of a chunk lie and how good each is, for sinks that want to know.
#pragma once

#include "bcc/Frame.h"
#include "tets/GradedTets.h"
#include "tets/TileTets.h"

#include <vdbtet/MeshSink.h>

#include <vector>

namespace vdbtet {

/// Grows by a tet at a time, in the order in which they are written.
class TetShapes {
public:
    explicit TetShapes(const MeshWants& wants = {}) : mWants(wants) {}

    bool wanted() const { return mWants.centroids || mWants.minDihedrals; }
    const std::vector<openvdb::Vec3d>& centroids() const { return mCentroids; }
    const std::vector<float>& minDihedrals() const { return mMinDihedrals; }
    void clear() {
        mCentroids.clear();
        mMinDihedrals.clear();
    }

    /// @param corners  in units of the lattice, seen from @a origin
    void add(const Frame& frame, const openvdb::Vec3d& origin, const std::array<openvdb::Vec3d, 4>& corners) {
        addCentroid(frame, origin, corners);
        if (mWants.minDihedrals) mMinDihedrals.push_back(minDihedral(corners));
    }

    /// The same for a tet of a known shape.
    void add(const Frame& frame, const openvdb::Vec3d& origin, const std::array<openvdb::Vec3d, 4>& corners,
             TetKind kind) {
        addCentroid(frame, origin, corners);
        if (mWants.minDihedrals) mMinDihedrals.push_back(float(kAnglesOfKind[int(kind)][0])); // ascending
    }

private:
    void addCentroid(const Frame& frame, const openvdb::Vec3d& origin,
                     const std::array<openvdb::Vec3d, 4>& corners) {
        if (!mWants.centroids) return;
        const openvdb::Vec3d mean = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        mCentroids.push_back(frame.world(origin + mean));
    }
    static float minDihedral(const std::array<openvdb::Vec3d, 4>& corners);

    MeshWants mWants;
    std::vector<openvdb::Vec3d> mCentroids;
    std::vector<float> mMinDihedrals; ///< degrees
};

} // namespace vdbtet
