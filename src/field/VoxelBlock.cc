/// @file VoxelBlock.cc
/// Kernels on rows of voxels and on batches of edges.
#include "field/VoxelBlock.h"

#include "field/Diagonal.h"
#include "field/Root.h"

#include <cstring>

namespace vdbtet {

namespace {

constexpr int kRow = PaddedMask::kRowBits;
/// The values of a row that are looked at: PaddedMask::kDim, rounded up to whole vectors.
constexpr int kLanes = 12;

/// The set of those of kLanes values that are inside.
VDBTET_KERNEL inline std::uint16_t insideBits(const double* values) {
    typedef double Doubles __attribute__((vector_size(32)));
    typedef long long Ints __attribute__((vector_size(32)));
    Ints bits = {0, 0, 0, 0}, weights = {1, 2, 4, 8};
    for (int i = 0; i < kLanes; i += 4, weights <<= 4) {
        Doubles v;
        std::memcpy(&v, values + i, sizeof v);
        bits |= (v >= 0.0) & weights;
    }
    return std::uint16_t(bits[0] | bits[1] | bits[2] | bits[3]);
}

/// The offsets from a voxel to the corners of the cube on its side in a direction.
struct CornerOffsets {
    int of[bcc::kDirections][8];

    constexpr CornerOffsets() : of() {
        for (int d = 0; d < bcc::kDirections; ++d) {
            for (int corner = 0; corner < 8; ++corner) {
                of[d][corner] = PaddedMask::step((corner >> 2) * bcc::sign(d, 0), (corner >> 1 & 1) * bcc::sign(d, 1),
                                                 (corner & 1) * bcc::sign(d, 2));
            }
        }
    }
};
constexpr CornerOffsets kCorners;

} // namespace

void VoxelBlock::corners(int n, int direction, double (&p)[8]) const {
    for (int corner = 0; corner < 8; ++corner) p[corner] = mPhi[n + kCorners.of[direction][corner]];
}

void VoxelBlock::signs(PaddedMask& a, PaddedMask& b) const {
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int r = 0; r < PaddedMask::kRows; ++r) a.rows[r] = insideBits(mPhi + r * kRow) & PaddedMask::kRow;
        // The mean of the eight corners, by pairs along z, then y, then x.
        constexpr int kCubes = PaddedMask::kDim - 1;
        double squares[2][kCubes][kLanes];
        for (int x = 0; x < PaddedMask::kDim; ++x) {
            auto& now = squares[x & 1];
            const auto& before = squares[~x & 1];
            for (int y = 0; y < kCubes; ++y) {
                const double* v = mPhi + (x * PaddedMask::kDim + y) * kRow;
                for (int z = 0; z < kLanes; ++z)
                    now[y][z] = (v[z] + v[z + 1]) + (v[z + kRow] + v[z + kRow + 1]);
            }
            if (x == 0) continue;
            for (int y = 0; y < kCubes; ++y) {
                double centres[kLanes];
                for (int z = 0; z < kLanes; ++z) centres[z] = 0.125 * (before[y][z] + now[y][z]);
                b.rows[(x - 1) * PaddedMask::kDim + y] = insideBits(centres) & (PaddedMask::kRow >> 1);
            }
        }
    });
}

PaddedMask VoxelBlock::nearerToA(int direction, const PaddedMask& cut) const {
    PaddedMask nearer;
    cut.forEach([&](int n) {
        double p[8];
        corners(n, direction, p);
        const Diagonal phi = Diagonal::of(p);
        nearer.rows[n >> 4] |= std::uint16_t(unsigned(cutInFirstHalf(p[0], phi(0.5), phi(1.0))) << (n & 15));
    });
    return nearer;
}

void VoxelBlock::cutPoints(bcc::Lattice lattice, const EdgeMasks& edges, float* distance) {
    mEdges.clear();
    for (int d = 0; d < bcc::kDirections; ++d) {
        // The voxel at the edge's L_A end, and the direction from there.
        const bcc::Step step = lattice == bcc::A ? bcc::Step{0, 0, 0} : bcc::shortEdge(bcc::B, d);
        const int toA = PaddedMask::step(step.x, step.y, step.z);
        const int fromA = lattice == bcc::A ? d : bcc::opposite(d);
        edges[d].forEach([&](int n) {
            double p[8];
            corners(PaddedMask::bit(n) + toA, fromA, p);
            const Diagonal phi = Diagonal::of(p);
            if (lattice == bcc::A) {
                mEdges.add(phi, p[0]);
                return;
            }
            // Summed in the order of signs(): else its sign could differ.
            double q[8];
            for (int corner = 0; corner < 8; ++corner) q[corner] = p[corner ^ bcc::opposite(fromA)];
            mEdges.add(phi, centreValue(q));
        });
    }
    distancesToCuts(mEdges, lattice == bcc::B, distance, mIsa);
}

} // namespace vdbtet
