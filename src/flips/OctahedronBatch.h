/// @file OctahedronBatch.h
/// Judges all three slices of octahedra, as many as there are lanes.
#pragma once

#include "bcc/Lattice.h"
#include "destinations/LocalVertices.h"
#include "simd/Isa.h"

namespace vdbtet {

class OctahedronBatch {
public:
    static constexpr int kLanes = 16;

    explicit OctahedronBatch(Isa isa = bestIsa()) : mIsa(isa) {}

    void set(int lane, const LocalPositions& positions, const LocalOctahedron& octahedron) {
        for (int v = 0; v < 6; ++v) {
            for (int axis = 0; axis < 3; ++axis) mAt[v][axis][lane] = positions[octahedron[v]][axis];
        }
    }

    /// Judge all lanes; those not set since have what they had.
    void judge();

    /// @return false where slices A and B have both a sharper and a wider angle than S has.
    bool mayGain(int lane) const { return mMayGain[lane] != 0; }

    /// worth() of all four tets.
    double worthOf(bcc::Slice slice, int lane) const;

private:
    template <int kSlice, int kTet>
    VDBTET_KERNEL inline void judgeTet();
    template <int kSlice>
    VDBTET_KERNEL inline void judgeSlice();

    Isa mIsa;
    double mAt[6][3][kLanes] = {};
    /// By slice: the signed squared cosines of the widest and the sharpest angle; the least volume.
    double mLeast[3][kLanes], mMost[3][kLanes], mVolume[3][kLanes];
    std::int64_t mMayGain[kLanes];
};

} // namespace vdbtet
