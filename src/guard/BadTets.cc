/// @file BadTets.cc
/// Tets that the surface moved, judged in lanes.
#include "guard/BadTets.h"

#include "guard/Guard.h"
#include "quality/Dihedral.h"
#include "simd/Isa.h"
#include "tets/TileTets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace vdbtet {

namespace {

/// The signed square of the cosine of an angle in degrees.
double signedSquare(double degrees) {
    const double cosine = std::cos(degrees * 0.017453292519943295);
    return cosine * std::abs(cosine);
}

/// Looks at one tile after another; one for each thread.
class BadTetFinder {
public:
    BadTetFinder(const Vertices& vertices, const Flips& flips)
        : mVertices(vertices), mTets(vertices, flips) {}

    /// @return whether there is a bad tet in the mesh
    bool find(TileRef tile, std::vector<VertexRef>& found) {
        mPositions.load(mVertices, tile);
        if (!mPositions.anyMoved()) return false;
        mAnyBad = false;
        mTile = tile;
        mFound = &found;
        mStates.load(mVertices, tile);
        mTets.load(tile, mStates);
        const auto addFlipped = [&](const LocalTet& tet) {
            add({tet.vertex(0), tet.vertex(1), tet.vertex(2), tet.vertex(3)}, tet.octahedron);
        };
        for (int axis = 0; axis < 3; ++axis) {
            for (int number = 0; number < 4; ++number) {
                const auto& tet = bcc::kSliceTets[bcc::S][number];
                TileMask moved = mTets.manifold(axis, tet[0]);
                for (int i = 1; i < 4; ++i) moved |= mTets.manifold(axis, tet[i]);
                // Where the shape is thin. None was flipped: those keep four tets in the mesh.
                const TileMask dropped = mTets.manifold(axis, tet[0]) & mTets.manifold(axis, tet[1]) &
                                         mTets.manifold(axis, tet[2]) & mTets.manifold(axis, tet[3]);
                dropped.forEach([&](int n) {
                    const LocalOctahedron o = localOctahedron(bcc::A, axis, localIndex(bcc::A, n));
                    for (const int v : tet) found.push_back(vertexOf(o[v]));
                });
                (moved & mTets.latticeTets(axis, number)).forEach([&](int n) {
                    const LocalOctahedron o = localOctahedron(bcc::A, axis, localIndex(bcc::A, n));
                    const std::array<int, 4> corners{o[tet[0]], o[tet[1]], o[tet[2]], o[tet[3]]};
                    add(corners, {corners[0], corners[1], corners[2], corners[3], corners[3], corners[3]});
                });
            }
            mTets.flippedSpines(axis).forEach([&](int n) { mTets.forEachTetOf(axis, n, addFlipped); });
        }
        mTets.forEachTetOfB(addFlipped);
        judge();
        return mAnyBad;
    }

private:
    static constexpr int kBatch = 64;

    /// @param toFlag  the vertices that are flagged if the tet is bad, some twice
    void add(const std::array<int, 4>& tet, const LocalOctahedron& toFlag) {
        for (int v = 0; v < 4; ++v) {
            for (int axis = 0; axis < 3; ++axis) mPlaces[3 * v + axis][mCount] = mPositions[tet[v]][axis];
        }
        mToFlag[std::size_t(mCount)] = toFlag;
        if (++mCount == kBatch) judge();
    }

    void judge() {
        runOn(mIsa, [&]() VDBTET_KERNEL {
            for (int i = 0; i < kBatch; ++i) {
                const auto vertex = [&](int v) VDBTET_KERNEL {
                    return Triple{mPlaces[3 * v][i], mPlaces[3 * v + 1][i], mPlaces[3 * v + 2][i]};
                };
                const Triple a = vertex(0), b = vertex(1), c = vertex(2), d = vertex(3);
                double squares[6];
                signedSquares(a, b, c, d, squares);
                bool fine = dot(b - a, cross(c - a, d - a)) > 0.0;
                for (int k = 0; k < 6; ++k) fine = fine & (squares[k] > mLeast) & (squares[k] < mMost);
                mBad[i] = fine ? 0 : 1;
            }
        });
        for (int i = 0; i < mCount; ++i) {
            if (mBad[i] == 0) continue;
            mAnyBad = true;
            for (const int local : mToFlag[std::size_t(i)]) {
                if (mStates.manifold(local)) mFound->push_back(vertexOf(local));
            }
        }
        mCount = 0;
    }

    VertexRef vertexOf(int local) const {
        const int n = bitOf(local), x = PaddedMask::x(n), y = PaddedMask::y(n), z = PaddedMask::z(n);
        const int slot = neighbourSlot(tileStep(x), tileStep(y), tileStep(z));
        return {mVertices.layout.neighbours[mTile][slot], latticeOf(local),
                TileMask::bit(x & 7, y & 7, z & 7)};
    }

    const Vertices& mVertices;
    Isa mIsa = bestIsa();
    const double mLeast = signedSquare(kGuardMax), mMost = signedSquare(kGuardMin);
    TileRef mTile = 0;
    LocalStates mStates;
    LocalPositions mPositions;
    TileTets mTets;
    std::vector<VertexRef>* mFound = nullptr;
    bool mAnyBad = false;
    int mCount = 0;
    double mPlaces[12][kBatch] = {};
    std::array<LocalOctahedron, kBatch> mToFlag;
    std::int64_t mBad[kBatch];
};

} // namespace

std::vector<VertexRef> verticesOfBadTets(const Vertices& vertices, const Flips& flips,
                                         const std::vector<TileRef>& tiles, std::vector<char>& hasBad,
                                         Interrupt& interrupt) {
    std::vector<std::vector<VertexRef>> parts(tiles.size());
    tbb::enumerable_thread_specific<std::unique_ptr<BadTetFinder>> finders(
        [&] { return std::make_unique<BadTetFinder>(vertices, flips); });
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        BadTetFinder& finder = *finders.local();
        for (std::int64_t i = begin; i < end; ++i) hasBad[tiles[i]] = finder.find(tiles[i], parts[i]) ? 1 : 0;
    });
    std::vector<VertexRef> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace vdbtet
