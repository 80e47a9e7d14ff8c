/// @file VoxelBlock.h
/// Signs and cut points of a tile whose L_A vertices are the voxel centres, from a copy of its voxels.
#pragma once

#include "bcc/Lattice.h"
#include "bits/PaddedMask.h"
#include "field/CutDistances.h"
#include "field/Field.h"
#include "field/Level.h"
#include "simd/Isa.h"

#include <array>

namespace vdbtet {

/// @brief The values phi of a tile's voxels and of a border of one around it, by PaddedMask::bit().
/// @details See Field::Sampler for what the members compute.
class VoxelBlock {
public:
    explicit VoxelBlock(Isa isa = bestIsa()) : mIsa(isa) {}

    /// @param leaves  the 512 voxels of each leaf around the tile, by neighbourSlot()
    template <typename T>
    void load(const std::array<const T*, 27>& leaves, const Level& level);

    void signs(PaddedMask& a, PaddedMask& b) const;
    void nearerToA(const std::vector<ShortEdge>& edges, std::uint8_t* nearer);
    void cutPoints(bcc::Lattice lattice, const std::vector<ShortEdge>& edges, float* distance);

private:
    /// Add the edge from voxel @a n in @a direction to mEdges.
    void addEdge(int n, int direction);

    /// The field at the centre of the cube whose lowest voxel is @a n: at that vertex of L_B.
    double centre(int n) const;

    Isa mIsa;
    /// What lies between the rows is zero; the last row is read beyond its end.
    alignas(64) double mPhi[PaddedMask::kSize + PaddedMask::kRowBits] = {};
    CutEdges mEdges;
};

extern template void VoxelBlock::load(const std::array<const float*, 27>&, const Level&);
extern template void VoxelBlock::load(const std::array<const double*, 27>&, const Level&);

} // namespace vdbtet
