/// @file VoxelBlock.cc
/// Kernels on rows of voxels and on batches of edges.
#include "field/VoxelBlock.h"

#include "field/Diagonal.h"

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

/// Call @a body with each direction as a constant.
template <typename Body>
void forEachDirection(const Body& body) {
    body(std::integral_constant<int, 0>());
    body(std::integral_constant<int, 1>());
    body(std::integral_constant<int, 2>());
    body(std::integral_constant<int, 3>());
    body(std::integral_constant<int, 4>());
    body(std::integral_constant<int, 5>());
    body(std::integral_constant<int, 6>());
    body(std::integral_constant<int, 7>());
}

} // namespace

template <typename T>
void VoxelBlock::load(const std::array<const T*, 27>& leaves, const Level& level) {
    const double isovalue = level.isovalue;
    const bool below = level.insideIsBelow;
    runOn(mIsa, [&]() VDBTET_KERNEL {
        for (int x = -1; x <= 8; ++x) {
            for (int y = -1; y <= 8; ++y) {
                const T* const* column = &leaves[neighbourSlot(tileStep(x), tileStep(y), -1)];
                const int n = TileMask::bit(x & 7, y & 7, 0);
                double* row = mPhi + PaddedMask::bit(x, y, 0);
                const auto copy = [&](const auto& phi) VDBTET_KERNEL {
                    row[-1] = phi(column[0][n + 7]);
                    for (int z = 0; z < 8; ++z) row[z] = phi(column[1][n + z]);
                    row[8] = phi(column[2][n]);
                };
                if (below) {
                    copy([=](double value) VDBTET_KERNEL { return isovalue - value; });
                } else {
                    copy([=](double value) VDBTET_KERNEL { return value - isovalue; });
                }
            }
        }
    });
}

template void VoxelBlock::load(const std::array<const float*, 27>&, const Level&);
template void VoxelBlock::load(const std::array<const double*, 27>&, const Level&);

template <int kDirection>
void VoxelBlock::addEdge(int n) {
    constexpr auto& kOffsets = kCorners.of[kDirection];
    for (int corner = 0; corner < 8; ++corner) mEdges.corners[corner][mEdges.count] = mPhi[n + kOffsets[corner]];
    ++mEdges.count;
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

EdgeRows VoxelBlock::nearerToA(const EdgeRows& cut) {
    EdgeRows nearer;
    std::array<std::int16_t, CutEdges::kLanes> edge; // of each lane: the direction and the vertex
    mEdges.count = 0;
    const auto flush = [&] {
        for (std::uint32_t set = cutsInFirstHalf(mEdges, mIsa); set != 0; set &= set - 1) {
            const int code = edge[lowestBit(set)];
            nearer[code & 7].set(code >> 3);
        }
        mEdges.count = 0;
    };
    forEachDirection([&](auto d) {
        cut[d].forEach([&](int n) {
            edge[mEdges.count] = std::int16_t(n << 3 | d);
            addEdge<d>(n);
            if (mEdges.full()) flush();
        });
    });
    flush();
    return nearer;
}

void VoxelBlock::cutPoints(bcc::Lattice lattice, const EdgeMasks& edges, float* distance) {
    const bool fromB = lattice == bcc::B;
    mEdges.count = 0;
    const auto flush = [&] {
        distancesToCuts(mEdges, fromB ? ~std::uint32_t(0) : 0, distance, mIsa);
        distance += mEdges.count;
        mEdges.count = 0;
    };
    forEachDirection([&](auto d) {
        edges[d].forEach([&](int vertex) {
            const int n = PaddedMask::bit(vertex);
            if (fromB) {
                // From its L_A end the edge runs the opposite way. The centre's value is summed in the order of
                // signs(): else its sign could differ.
                constexpr bcc::Step step = bcc::shortEdge(bcc::B, d);
                mEdges.near[mEdges.count] = centre(n);
                addEdge<bcc::opposite(d)>(n + PaddedMask::step(step.x, step.y, step.z));
            } else {
                mEdges.near[mEdges.count] = mPhi[n];
                addEdge<d>(n);
            }
            if (mEdges.full()) flush();
        });
    });
    flush();
}

double VoxelBlock::centre(int n) const {
    double p[8];
    for (int corner = 0; corner < 8; ++corner) p[corner] = mPhi[n + kCorners.of[7][corner]];
    return centreValue(p);
}

} // namespace vdbtet
