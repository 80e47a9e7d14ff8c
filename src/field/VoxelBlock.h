/// @file VoxelBlock.h
/// Signs and cut points of a tile whose L_A vertices are the voxel centres, from a copy of its voxels.
#pragma once

#include "bcc/Lattice.h"
#include "bits/PaddedMask.h"
#include "field/CutDistances.h"
#include "field/Field.h"
#include "field/Level.h"
#include "field/Trilinear.h"
#include "simd/Isa.h"

#include <array>
#include <cmath>

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
    void nearerToA(const PaddedEdgeMasks& edges, double tau, PaddedEdgeMasks& nearer) const;
    void cutPoints(bcc::Lattice lattice, const std::vector<ShortEdge>& edges, double tau, float* distance);

    /// @return the field at a vertex of the tile, by its PaddedMask::bit().
    double at(bcc::Lattice lattice, int n) const { return lattice == bcc::A ? mPhi[n] : centre(n); }

    /// The field at the far ends of the short edges of a vertex of the tile.
    void around(bcc::Lattice lattice, int n, double (&phi)[bcc::kDirections]) const {
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(lattice, d);
            phi[d] = at(bcc::other(lattice), n + PaddedMask::step(step.x, step.y, step.z));
        }
    }

    /// @return the field at an offset, each component less than 1, from a vertex of the tile.
    /// @param beyond  gives phi of a voxel that is not in the block, relative to the tile's first one
    template <typename Beyond>
    double near(bcc::Lattice lattice, int n, const openvdb::Vec3d& offset, Beyond&& beyond) const {
        const double shift = 0.5 * lattice;
        const double place[3] = {PaddedMask::x(n) + shift + offset.x(), PaddedMask::y(n) + shift + offset.y(),
                                 PaddedMask::z(n) + shift + offset.z()};
        int low[3];
        for (int axis = 0; axis < 3; ++axis) low[axis] = int(std::floor(place[axis]));
        double p[8];
        if (low[0] < TileMask::kDim && low[1] < TileMask::kDim && low[2] < TileMask::kDim) {
            const double* first = mPhi + PaddedMask::bit(low[0], low[1], low[2]);
            for (int corner = 0; corner < 8; ++corner)
                p[corner] = first[PaddedMask::step(corner >> 2, corner >> 1 & 1, corner & 1)];
        } else {
            for (int corner = 0; corner < 8; ++corner)
                p[corner] = beyond(openvdb::Coord(low[0], low[1], low[2])
                                       .offsetBy(corner >> 2, corner >> 1 & 1, corner & 1));
        }
        return trilinear(p, place[0] - low[0], place[1] - low[1], place[2] - low[2]);
    }

private:
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
