/// @file VoxelBlock.h
/// Signs and cut points of a tile whose L_A vertices are the voxel centres, from a copy of its voxels.
#pragma once

#include "bcc/Lattice.h"
#include "bits/PaddedMask.h"
#include "field/CutDistances.h"
#include "field/Field.h"
#include "simd/Isa.h"

namespace vdbtet {

/// @brief The values phi of a tile's voxels and of a border of one around it, by PaddedMask::bit().
/// @details See Field::Sampler for what the members compute.
class VoxelBlock {
public:
    explicit VoxelBlock(Isa isa = bestIsa()) : mIsa(isa) {}

    double* row(int x, int y) { return mPhi + PaddedMask::bit(x, y, 0); }

    void signs(PaddedMask& a, PaddedMask& b) const;
    PaddedMask nearerToA(int direction, const PaddedMask& cut) const;
    void cutPoints(bcc::Lattice lattice, const EdgeMasks& edges, float* distance);

private:
    /// The corners of the cube on the side of voxel @a n in @a direction; p[0] is that voxel's.
    void corners(int n, int direction, double (&p)[8]) const;

    Isa mIsa;
    /// What lies between the rows is zero; the last row is read beyond its end.
    alignas(64) double mPhi[PaddedMask::kSize + PaddedMask::kRowBits] = {};
    CutEdges mEdges;
};

} // namespace vdbtet
