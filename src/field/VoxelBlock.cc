/// @file VoxelBlock.cc
/// Kernels on rows of voxels and on batches of edges.
#include "field/VoxelBlock.h"

#include "field/Diagonal.h"
#include "field/VoxelCube.h"

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

/// The cubes of voxels whose centres are set.
struct CubeList {
    explicit CubeList(const PaddedMask& centres) {
        centres.forEach([&](int n) { lowest[count++] = std::uint16_t(n); });
    }

    int count = 0;
    std::uint16_t lowest[PaddedMask::kDim * PaddedMask::kDim * PaddedMask::kDim];
};

/// Masks of the centres of cubes for each of their corners, a lane a corner while they are being made.
class CornerRows {
public:
    /// Add the nearer corners of a cube.
    template <bool kHalved>
    VDBTET_KERNEL void add(const double* block, int lowest, double tau) {
        VoxelCube::Corners corners;
        VoxelCube(block + lowest).nearer<kHalved>(tau, corners);
        const auto bit = std::uint16_t(1 << lowest % kRow);
        mRows[lowest / kRow] |= Lanes(corners) & bit;
    }

    /// @param masks  receives the mask of each corner
    VDBTET_KERNEL void sort(PaddedEdgeMasks& masks) {
        for (int r = 0; r < kCentreRows; r += 8) {
            // Transposed by three perfect shuffles.
            Lanes block[2][8];
            std::memcpy(block[0], mRows + r, sizeof block[0]);
            for (int stage = 0; stage < 3; ++stage) {
                const auto& from = block[stage % 2];
                auto& to = block[1 - stage % 2];
                for (int i = 0; i < 4; ++i) {
                    to[2 * i] = __builtin_shufflevector(from[i], from[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
                    to[2 * i + 1] = __builtin_shufflevector(from[i], from[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
                }
            }
            for (int corner = 0; corner < bcc::kDirections; ++corner)
                std::memcpy(masks[corner].rows + r, &block[1][corner], sizeof(Lanes));
        }
    }

private:
    typedef std::uint16_t Lanes __attribute__((vector_size(16)));
    /// No centre is in the last slab; rounded up to whole blocks.
    static constexpr int kCentreRows = PaddedMask::kRows - PaddedMask::kDim + 6;
    static_assert(kCentreRows % 8 == 0 && kCentreRows <= PaddedMask::kRows, "blocks of eight rows");
    Lanes mRows[kCentreRows] = {};
};

} // namespace

template <typename T>
void VoxelBlock::load(const std::array<const T*, 27>& leaves, const Level& level) {
    const double levelIsovalue = level.isovalue, levelSign = level.insideIsBelow ? -1.0 : 1.0;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        const double isovalue = levelIsovalue, sign = levelSign; // which no store to a row can change
        double* row = mPhi + PaddedMask::bit(-1, -1, 0);
        for (int x = -1; x <= TileMask::kDim; ++x) {
            for (int leafY = -1; leafY <= 1; ++leafY) {
                const T* const* column = &leaves[neighbourSlot(tileStep(x), leafY, 0)];
                const T *below = column[-1], *own = column[0], *above = column[1];
                const int first = leafY < 0 ? TileMask::kDim - 1 : 0, end = leafY > 0 ? 1 : TileMask::kDim;
                for (int y = first; y < end; ++y, row += kRow) {
                    const int n = TileMask::bit(x & 7, y, 0);
                    // The whole row of a leaf at a time, then the ends of its neighbours.
                    for (int z = 0; z < TileMask::kDim; z += 4) {
                        typedef T Values __attribute__((vector_size(4 * sizeof(T))));
                        typedef double Doubles __attribute__((vector_size(4 * sizeof(double))));
                        Values values;
                        std::memcpy(&values, own + n + z, sizeof values);
                        const Doubles phi = sign * (__builtin_convertvector(values, Doubles) - isovalue);
                        std::memcpy(row + z, &phi, sizeof phi);
                    }
                    row[-1] = sign * (double(below[n + 7]) - isovalue);
                    row[8] = sign * (double(above[n]) - isovalue);
                }
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
    });
    // Where all corners agree, so does the centre.
    PaddedMask mixed;
    constexpr int kFar = PaddedMask::kDim + 1;
    for (int r = 0; r < PaddedMask::kRows - kFar; ++r) {
        const int all = a.rows[r] & a.rows[r + 1] & a.rows[r + kFar - 1] & a.rows[r + kFar],
                  any = a.rows[r] | a.rows[r + 1] | a.rows[r + kFar - 1] | a.rows[r + kFar];
        b.rows[r] = std::uint16_t(all & all >> 1);
        mixed.rows[r] = std::uint16_t((any | any >> 1) & ~b.rows[r] & PaddedMask::kRow >> 1);
    }
    for (int x = 0; x < PaddedMask::kDim; ++x) mixed.rows[(x + 1) * PaddedMask::kDim - 1] = 0; // beyond
    CubeList cubes(mixed);
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int i = 0; i < cubes.count; ++i) {
            const int n = cubes.lowest[i];
            b.set(n, VoxelCube(mPhi + n).centre() >= 0.0);
        }
    });
}

void VoxelBlock::nearerToA(const PaddedEdgeMasks& edges, double tau, PaddedEdgeMasks& nearer) const {
    PaddedMask centres;
    for (int d = 0; d < bcc::kDirections; ++d) {
        const bcc::Step step = bcc::shortEdge(bcc::A, d);
        centres.add(edges[d].movedDown(PaddedMask::step(-step.x, -step.y, -step.z)));
    }
    const CubeList cubes(centres);
    PaddedEdgeMasks found;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        CornerRows rows;
        if (tau == 0.5) {
            for (int i = 0; i < cubes.count; ++i) rows.add<true>(mPhi, cubes.lowest[i], tau);
        } else {
            for (int i = 0; i < cubes.count; ++i) rows.add<false>(mPhi, cubes.lowest[i], tau);
        }
        rows.sort(found);
    });
    for (int corner = 0; corner < bcc::kDirections; ++corner) {
        // From its corner the edge runs the opposite way.
        const int d = bcc::opposite(corner);
        const bcc::Step step = bcc::shortEdge(bcc::B, corner);
        PaddedMask ends = found[corner].movedUp(PaddedMask::step(step.x, step.y, step.z));
        ends.intersect(edges[d]);
        nearer[d].add(ends);
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
