/// @file Ball.h
/// The tets at one vertex, and how good they would be were the vertex elsewhere.
#pragma once

#include "optimize/TetQuality.h"
#include "simd/Isa.h"

#include <openvdb/Types.h>

#include <array>

namespace vdbtet {

/// @brief The tets at one vertex by the faces opposite to it, in lanes.
class Ball {
public:
    /// No star has more: a vertex is in 18 octahedra, and in at most four tets of each.
    static constexpr int kMost = 72;

    explicit Ball(Isa isa = bestIsa()) : mIsa(isa) {}

    void clear() { mCount = 0; }
    int size() const { return mCount; }

    /// The other vertices of a tet, for the caller.
    using Face = std::array<int, 3>;

    /// Add the tet of the vertex v and @a face, at (a,b,c), such that (v,a,b,c) is positively oriented.
    void add(const Face& face, const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c) {
        int row = 0;
        for (const openvdb::Vec3d* p : {&a, &b, &c}) {
            for (int axis = 0; axis < 3; ++axis) mPlaces[row++][mCount] = (*p)[axis];
        }
        mFaces[mCount++] = face;
    }

    /// All tets have been added.
    void complete();

    /// Judge the ball with its vertex at @a at.
    BallQuality judge(const openvdb::Vec3d& at);

    /// Bring the worst tets to the front, worst first, as they were judged.
    /// @param front  how many at most
    void sort(int front);

    /// A tet, and its quality when it was judged.
    const Face& face(int i) const { return mFaces[i]; }
    double quality(int i) const { return mQuality[i]; }

    /// @brief Find how the qualities of the first tets change with the place of the vertex.
    /// @param at     where the ball was judged
    /// @param count  no more than kLanes
    void gradients(const openvdb::Vec3d& at, int count, openvdb::Vec3d* gradients) const;

    /// @brief Judge the ball with its vertex at @a at.
    /// @return whether it passes @a limits
    bool passes(const openvdb::Vec3d& at, const BallLimits& limits) const;

    static constexpr int kLanes = 8;

private:
    struct Block;

    Isa mIsa;
    int mCount = 0;
    std::array<Face, kMost> mFaces;
    alignas(64) double mPlaces[9][kMost]; ///< the last lanes of a block repeat some tet
    alignas(64) double mQuality[kMost];
};

} // namespace vdbtet
