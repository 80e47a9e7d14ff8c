/// @file VoxelCube.h
/// The short edges between the corners and the centre of a cube of voxels, all eight at a time.
#pragma once

#include "bits/PaddedMask.h"
#include "field/Root.h"
#include "simd/Isa.h"

#include <cstdint>
#include <cstring>

namespace vdbtet {

/// @brief The values at the corners of a cube of voxels, in lanes: 4i + 2j + k at corner (i,j,k), which is
/// where the centre's short edge in that direction leads.
class VoxelCube {
public:
    /// @param lowest  the value at its lowest corner, in a block of values by PaddedMask::bit()
    VDBTET_KERNEL explicit VoxelCube(const double* lowest) {
        join(lowest, lowest + PaddedMask::step(0, 1, 0), mHalf[0]);
        join(lowest + PaddedMask::step(1, 0, 0), lowest + PaddedMask::step(1, 1, 0), mHalf[1]);
    }

    /// @return the field at the centre, summed in the order of centreValue().
    VDBTET_KERNEL double centre() const {
        Four sums[2];
        for (int i = 0; i < 2; ++i)
            sums[i] = mHalf[i] + __builtin_shufflevector(mHalf[i], mHalf[i], 1, 0, 3, 2);
        return 0.125 * ((sums[0][0] + sums[0][2]) + (sums[1][0] + sums[1][2]));
    }

    /// A number a corner: all bits or none.
    typedef std::int16_t Corners __attribute__((vector_size(16)));

    /// @brief Find the corners whose edge is cut, and they nearer to the cut point than the centre is, or
    /// tied: cutInFirstPart() of each edge from its corner on.
    /// @param tau  the end inside is the nearer one up to this fraction of an edge
    /// @param kHalved  whether that is 1/2
    template <bool kHalved>
    VDBTET_KERNEL void nearer(double tau, Corners& corners) const {
        const double middle = centre();
        const long long centreInside = middle >= 0.0 ? -1 : 0;
        // An edge is half a diagonal.
        Four inside[2], outside[2];
        mix(0.5 * tau, inside);
        if (!kHalved) mix(0.5 * (1.0 - tau), outside);
        Ints found[2];
        for (int i = 0; i < 2; ++i) {
            const Ints isInside = mHalf[i] >= 0.0;
            Four end = inside[i];
            if (!kHalved) end = isInside ? inside[i] : outside[i];
            const Four rise = middle - mHalf[i], limit = kMiddle * (rise >= 0.0 ? rise : -rise);
            const Ints isTied = (end <= limit) & (end >= -limit);
            found[i] = (isInside ^ centreInside) & ((isInside ^ (end >= 0.0)) | isTied);
        }
        // The lowest quarter of each number.
        typedef std::int16_t Quarters __attribute__((vector_size(32)));
        corners =
            __builtin_shufflevector(Quarters(found[0]), Quarters(found[1]), 0, 4, 8, 12, 16, 20, 24, 28);
    }

private:
    typedef double Two __attribute__((vector_size(16)));
    typedef double Four __attribute__((vector_size(32)));
    typedef long long Ints __attribute__((vector_size(32)));

    VDBTET_KERNEL static void join(const double* low, const double* high, Four& four) {
        Two parts[2];
        std::memcpy(&parts[0], low, sizeof(Two));
        std::memcpy(&parts[1], high, sizeof(Two));
        four = __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3);
    }

    /// The field at a fraction @a t of the diagonals from the corners, one axis after the other.
    VDBTET_KERNEL void mix(double t, Four (&at)[2]) const {
        const double s = 1.0 - t;
        for (int i = 0; i < 2; ++i) {
            const Four x = s * mHalf[i] + t * mHalf[1 - i];
            const Four y = s * x + t * __builtin_shufflevector(x, x, 2, 3, 0, 1);
            at[i] = s * y + t * __builtin_shufflevector(y, y, 1, 0, 3, 2);
        }
    }

    Four mHalf[2]; ///< by x
};

} // namespace vdbtet
