/// @file VoxelBlock.cc
/// Kernels on rows of voxels and on batches of edges.
#include "field/VoxelBlock.h"

#include "field/Diagonal.h"

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
                of[d][corner] =
                    PaddedMask::step((corner >> 2) * bcc::sign(d, 0), (corner >> 1 & 1) * bcc::sign(d, 1),
                                     (corner & 1) * bcc::sign(d, 2));
            }
        }
    }
};
constexpr CornerOffsets kCorners;

} // namespace

template <typename T>
void VoxelBlock::load(const std::array<const T*, 27>& leaves, const Level& level) {
    const double levelIsovalue = level.isovalue, levelSign = level.insideIsBelow ? -1.0 : 1.0;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        const double isovalue = levelIsovalue, sign = levelSign; // which no store to a row can change
        for (int x = -1; x <= TileMask::kDim; ++x) {
            for (int y = -1; y <= TileMask::kDim; ++y) {
                const T* const* column = &leaves[neighbourSlot(tileStep(x), tileStep(y), 0)];
                const int n = TileMask::bit(x & 7, y & 7, 0);
                // The whole row of a leaf at a time, then the ends of its neighbours.
                double values[TileMask::kDim];
                for (int z = 0; z < TileMask::kDim; ++z)
                    values[z] = sign * (double(column[0][n + z]) - isovalue);
                double* row = mPhi + PaddedMask::bit(x, y, 0);
                std::memcpy(row, values, sizeof values);
                row[-1] = sign * (double(column[-1][n + 7]) - isovalue);
                row[8] = sign * (double(column[1][n]) - isovalue);
            }
        }
    });
}

template void VoxelBlock::load(const std::array<const float*, 27>&, const Level&);
template void VoxelBlock::load(const std::array<const double*, 27>&, const Level&);

void VoxelBlock::addEdge(int n, int direction, double tau) {
    const auto& offsets = kCorners.of[direction];
    mEdges.tau[mEdges.count] = tau;
    double* corner = &mEdges.corners[0][mEdges.count++];
    for (int i = 0; i < 8; ++i) corner[i * CutEdges::kLanes] = mPhi[n + offsets[i]];
}

void VoxelBlock::signs(PaddedMask& a, PaddedMask& b) const {
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int r = 0; r < PaddedMask::kRows; ++r)
            a.rows[r] = insideBits(mPhi + r * kRow) & PaddedMask::kRow;
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

void VoxelBlock::nearerToA(const std::vector<ShortEdge>& edges, double tau, std::uint8_t* nearer) {
    for (std::size_t i = 0; i < edges.size();) {
        mEdges.count = 0;
        for (; i < edges.size() && !mEdges.full(); ++i)
            addEdge(edges[i].vertex, edges[i].direction, edges[i].halved ? 0.5 : tau);
        const std::uint32_t first = cutsInFirstPart(mEdges, mIsa);
        for (int lane = 0; lane < mEdges.count; ++lane) *nearer++ = first >> lane & 1;
    }
}

void VoxelBlock::cutPoints(bcc::Lattice lattice, const std::vector<ShortEdge>& edges, double tau,
                           float* distance) {
    for (std::size_t i = 0; i < edges.size();) {
        mEdges.count = 0;
        for (; i < edges.size() && !mEdges.full(); ++i) {
            const int n = edges[i].vertex, direction = edges[i].direction;
            const double own = edges[i].halved ? 0.5 : tau;
            if (lattice == bcc::A) {
                mEdges.near[mEdges.count] = mPhi[n];
                addEdge(n, direction, own);
            } else {
                // From its L_A end the edge runs the opposite way. The centre's value is summed in the order
                // of signs(): else its sign could differ.
                const bcc::Step step = bcc::shortEdge(bcc::B, direction);
                mEdges.near[mEdges.count] = centre(n);
                addEdge(n + PaddedMask::step(step.x, step.y, step.z), bcc::opposite(direction), own);
            }
        }
        distancesToCuts(mEdges, lattice == bcc::B, distance, mIsa);
        distance += mEdges.count;
    }
}

double VoxelBlock::centre(int n) const {
    double p[8];
    for (int corner = 0; corner < 8; ++corner) p[corner] = mPhi[n + kCorners.of[7][corner]];
    return centreValue(p);
}

} // namespace vdbtet
