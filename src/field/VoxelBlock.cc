/// @file VoxelBlock.cc
/// Kernels on rows of voxels and on batches of edges.
#include "field/VoxelBlock.h"

#include "field/Diagonal.h"
#include "field/Root.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

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

/// The field on the short edge from a voxel in a direction, known to the compiler, and so are the voxels'
/// places.
template <int kDirection>
inline Diagonal diagonalAt(const double* voxel) {
    constexpr int x = PaddedMask::step(bcc::sign(kDirection, 0), 0, 0),
                  y = PaddedMask::step(0, bcc::sign(kDirection, 1), 0), z = bcc::sign(kDirection, 2);
    return Diagonal::of(
        {voxel[0], voxel[z], voxel[y], voxel[y + z], voxel[x], voxel[x + z], voxel[x + y], voxel[x + y + z]});
}

/// Call @a work with a direction as a constant.
template <typename Work>
decltype(auto) withDirection(int direction, Work&& work) {
    switch (direction) {
    case 0:
        return work(std::integral_constant<int, 0>());
    case 1:
        return work(std::integral_constant<int, 1>());
    case 2:
        return work(std::integral_constant<int, 2>());
    case 3:
        return work(std::integral_constant<int, 3>());
    case 4:
        return work(std::integral_constant<int, 4>());
    case 5:
        return work(std::integral_constant<int, 5>());
    case 6:
        return work(std::integral_constant<int, 6>());
    default:
        return work(std::integral_constant<int, 7>());
    }
}

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

void VoxelBlock::nearerToA(const PaddedEdgeMasks& edges, double tau, PaddedEdgeMasks& nearer) const {
    // By whether the L_A end is inside: what the diagonal's coefficients weigh where the first part ends.
    double weights[2][4];
    for (int isInside = 0; isInside < 2; ++isInside) {
        const double s = 0.5 * (isInside ? tau : 1.0 - tau), r = 1.0 - s;
        const double all[4] = {r * r * r, r * r * s, r * s * s, s * s * s};
        std::copy_n(all, 4, weights[isInside]);
    }
    for (int d = 0; d < bcc::kDirections; ++d) {
        withDirection(d, [&](auto direction) {
            edges[d].forEach([&](int n) {
                const Diagonal phi = diagonalAt<direction>(mPhi + n);
                const double(&w)[4] = weights[phi.b0 >= 0.0];
                const double middle = (w[0] * phi.b0 + w[1] * phi.b1) + (w[2] * phi.b2 + w[3] * phi.b3),
                             centre = 0.125 * ((phi.b0 + phi.b1) + (phi.b2 + phi.b3));
                nearer[d].set(n, cutInFirstPart(phi.b0, middle, centre));
            });
        });
    }
}

void VoxelBlock::cutPoints(bcc::Lattice lattice, const std::vector<ShortEdge>& edges, double tau,
                           float* distance) {
    for (std::size_t i = 0; i < edges.size();) {
        mEdges.count = 0;
        for (; i < edges.size() && !mEdges.full(); ++i) {
            const int n = edges[i].vertex, direction = edges[i].direction;
            const double own = edges[i].halved ? 0.5 : tau;
            // From its L_A end the edge runs the opposite way. The centre's value is summed in the order of
            // signs(): else its sign could differ.
            const int back = lattice == bcc::A ? direction : bcc::opposite(direction);
            const bcc::Step step = bcc::shortEdge(bcc::B, direction);
            const int voxel = lattice == bcc::A ? n : n + PaddedMask::step(step.x, step.y, step.z);
            const double near = lattice == bcc::A ? mPhi[n] : centre(n);
            mEdges.add(withDirection(back, [&](auto d) { return diagonalAt<d>(mPhi + voxel); }), near, own);
        }
        distancesToCuts(mEdges, lattice == bcc::B, distance, mIsa);
        distance += mEdges.count;
    }
}

double VoxelBlock::centre(int n) const {
    double p[8];
    for (int corner = 0; corner < 8; ++corner)
        p[corner] = mPhi[n + PaddedMask::step(corner >> 2, corner >> 1 & 1, corner & 1)];
    return centreValue(p);
}

} // namespace vdbtet
