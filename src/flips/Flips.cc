/// @file Flips.cc
/// Algorithms 4 and 5 (paper, sections 4.4 and 6.2), a tile at a time.
#include "flips/Flips.h"

#include "flips/Slices.h"

#include <vdbtet/VolumeToTets.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace vdbtet {

namespace {

/// @return the direction of the short edge between two neighbours, which may be of any octahedron.
int directionBetween(int from, int to) {
    const openvdb::Vec3d edge = homeOf(to) - homeOf(from);
    return 4 * (edge.x() > 0.0) + 2 * (edge.y() > 0.0) + (edge.z() > 0.0);
}

} // namespace

ExtraFlip chooseExtraSlice(const LocalVertices& vertices, const LocalOctahedron& octahedron) {
    const Destinations& destinations = vertices.destinations();
    ExtraFlip flip;
    // v2 is the manifold end. Where it is the lower one the figure is seen in a mirror, which swaps its two
    // cases and nothing else.
    const bool reversed = vertices.manifold(octahedron[0]);
    const int v1 = octahedron[reversed ? 1 : 0], v2 = octahedron[reversed ? 0 : 1];
    if (vertices.state(v1) != State::Inside || !vertices.manifold(v2)) return flip;

    const auto isFar = [&](int v) {
        return vertices.manifold(v) && destinations.distances[vertices.moveOf(v)] >= kExtremeMove;
    };
    // Whether v moves far in the direction from another vertex to v2.
    const auto movesFar = [&](int v, int from) {
        return isFar(v) && destinations.directions[vertices.moveOf(v)] == directionBetween(from, v2);
    };
    for (int k = 0; k < 4; ++k) {
        const auto ring = [&](int i) { return octahedron[2 + (k + i) % 4]; };
        const int v3 = ring(0), v4 = ring(1), v5 = ring(2), v6 = ring(3);
        if (!movesFar(v3, v4) || !movesFar(v4, v3)) continue;
        const bool from5 = movesFar(v2, v5), from6 = movesFar(v2, v6);
        if (!from5 && !from6) continue;

        flip.matches = true;
        const bool manifold5 = vertices.manifold(v5), manifold6 = vertices.manifold(v6);
        flip.conflict = manifold5 || manifold6;
        if (!flip.conflict) {
            // The new edge ends at v5 or v6, of which v5 is the (k+2)-th of the ring.
            flip.slice = (k % 2 == 0) == from5 ? bcc::SliceA : bcc::SliceB;
        } else if (!(manifold5 && manifold6) && !isFar(manifold5 ? v5 : v6)) {
            // So short a move rules out that the edge (v5,v6) wants a flip as well.
            SliceQuality best = sliceQuality(vertices, octahedron, bcc::S);
            for (bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
                const SliceQuality quality = sliceQuality(vertices, octahedron, slice);
                if (better(quality, best)) {
                    best = quality;
                    flip.slice = slice;
                }
            }
        }
        return flip; // v4 cannot move two ways, so no other pair matches
    }
    return flip;
}

namespace {

/// Chooses the flips of one tile after another.
class TileFlipper {
public:
    /// @param farMoves  by surface tile and lattice, the manifold vertices that move at least kExtremeMove
    TileFlipper(const Vertices& vertices, const std::vector<std::array<TileMask, 2>>& farMoves,
                bool withExtra)
        : mVertices(vertices), mFarMoves(farMoves), mWithExtra(withExtra), mLocal(vertices) {}

    struct Result {
        std::vector<std::uint16_t> codes; ///< sorted
        std::vector<TileMask> suspects;   ///< by lattice; empty where there are none
        std::int32_t active = 0, extra = 0, lastResort = 0, conflicts = 0;
    };

    Result flip(TileRef tile) {
        Result result;
        mConflicts.clear();
        if (!nearManifold(tile)) return result;
        mLocal.load(tile);
        const Surroundings around(mVertices.layout.neighbours[tile]);
        for (int lattice = 0; lattice < 2; ++lattice) {
            if (mWithExtra) mFar[lattice] = PaddedMask(around.masks(mFarMoves, lattice));
        }
        mCodes.clear();
        mActive.clear();
        mOctahedra.clear();
        flipAlong<bcc::A, 0>(result);
        flipAlong<bcc::A, 1>(result);
        flipAlong<bcc::A, 2>(result);
        flipAlong<bcc::B, 0>(result);
        flipAlong<bcc::B, 1>(result);
        flipAlong<bcc::B, 2>(result);
        flipActive(result);
        std::sort(mCodes.begin(), mCodes.end());
        result.codes.assign(mCodes.begin(), mCodes.end());
        const auto suspects = findSuspects(mLocal);
        if (suspects[bcc::A].any() || suspects[bcc::B].any())
            result.suspects.assign(suspects.begin(), suspects.end());
        return result;
    }

    /// The centres of the conflicts of the tile flipped last, seen from it.
    const std::vector<openvdb::Vec3d>& conflicts() const { return mConflicts; }

private:
    /// An octahedron that may be flipped has a manifold vertex.
    bool nearManifold(TileRef tile) const {
        for (TileRef from : mVertices.layout.neighbours[tile]) {
            if (from >= 0 && mVertices.destinations.any(from)) return true;
        }
        return false;
    }

    /// Find the spines of one kind that Algorithm 4 flips, and flip those of Algorithm 5.
    template <bcc::Lattice lattice, int axis>
    void flipAlong(Result& result) {
        PaddedMask active, extra;
        findSpines<lattice, axis>(active, extra);
        if (active.any()) {
            active.core().forEach([&](int n) {
                mActive.push_back({lattice, axis, bcc::S, n});
                mOctahedra.push_back(localOctahedron(lattice, axis, localIndex(lattice, n)));
            });
        }
        if (extra.any()) flipExtra(lattice, axis, extra.core(), result);
    }

    /// @param active  receives the spines between vertices inside and outside that are not manifold
    /// @param extra   receives those from a vertex inside to one that moves far, as two neighbours on the
    /// ring do
    template <bcc::Lattice lattice, int axis>
    void findSpines(PaddedMask& active, PaddedMask& extra) const {
        static const PaddedMask kOwn = PaddedMask::filledCore();
        const auto &interior = mLocal.interiorMask(lattice).rows,
                   &manifold = mLocal.manifoldMask(lattice).rows, &far = mFar[lattice].rows,
                   &farOnRing = mFar[bcc::other(lattice)].rows;
        constexpr int kFirst = PaddedMask::kDim + 1, kEnd = PaddedMask::kRows - kFirst; // of the tile itself
        for (int r = kFirst; r < kEnd; ++r) {
            const auto up = [&](const auto& rows) {
                return std::uint16_t(rows[r + (axis == 0) * PaddedMask::kDim + (axis == 1)] >> (axis == 2));
            };
            const auto ring = [&](int i) {
                const bcc::Vertex& v = bcc::kOctahedra[lattice][axis][2 + i];
                const std::uint16_t row = farOnRing[r + v.x * PaddedMask::kDim + v.y];
                return std::uint16_t(v.z < 0 ? row + row : row >> v.z);
            };
            active.rows[r] =
                std::uint16_t((interior[r] ^ up(interior)) & ~(manifold[r] | up(manifold)) & kOwn.rows[r]);
            extra.rows[r] = std::uint16_t(((interior[r] & up(far)) | (far[r] & up(interior))) &
                                          (ring(0) | ring(2)) & (ring(1) | ring(3)) & kOwn.rows[r]);
        }
    }

    void flipActive(Result& result) {
        chooseActiveSlices(mLocal, mOctahedra, SliceRule::Policy, mSlices);
        for (std::size_t i = 0; i < mActive.size(); ++i) {
            mActive[i].slice = mSlices[i];
            mCodes.push_back(Flips::encode(mActive[i]));
        }
        result.active = std::int32_t(mActive.size());
    }

    /// Algorithm 5.
    void flipExtra(bcc::Lattice lattice, int axis, const TileMask& spines, Result& result) {
        spines.forEach([&](int n) {
            const LocalOctahedron octahedron = localOctahedron(lattice, axis, localIndex(lattice, n));
            const ExtraFlip flip = chooseExtraSlice(mLocal, octahedron);
            if (flip.conflict) {
                ++result.conflicts;
                mConflicts.push_back(0.5 * (homeOf(octahedron[0]) + homeOf(octahedron[1])));
            }
            if (flip.slice == bcc::S) return;
            mCodes.push_back(Flips::encode({lattice, axis, flip.slice, n}));
            ++(flip.conflict ? result.lastResort : result.extra);
        });
    }

    const Vertices& mVertices;
    const std::vector<std::array<TileMask, 2>>& mFarMoves;
    bool mWithExtra;
    LocalVertices mLocal;
    PaddedMask mFar[2];                ///< mFarMoves around the tile
    std::vector<std::uint16_t> mCodes; ///< of the tile
    std::vector<openvdb::Vec3d> mConflicts;
    std::vector<Flip> mActive;
    std::vector<LocalOctahedron> mOctahedra; ///< of mActive
    std::vector<bcc::Slice> mSlices;         ///< for mOctahedra
};

std::vector<std::array<TileMask, 2>> findFarMoves(const Vertices& vertices, Interrupt& interrupt) {
    const std::int64_t tiles = vertices.layout.surfaceCount();
    std::vector<std::array<TileMask, 2>> far(tiles);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            for (int lattice = 0; lattice < 2; ++lattice) {
                const float* distance =
                    vertices.destinations.distances.data() + vertices.destinations.first[t][lattice];
                for (int w = 0; w < TileMask::kDim; ++w) {
                    std::uint64_t left = vertices.labels.manifold[t][lattice].words[w];
                    for (; left != 0; left &= left - 1) {
                        const std::uint64_t isFar = *distance++ >= kExtremeMove ? 1 : 0;
                        far[t][lattice].words[w] |= isFar << lowestBit(left);
                    }
                }
            }
        }
    });
    return far;
}

} // namespace

Flips chooseFlips(const Vertices& vertices, int version, Interrupt& interrupt) {
    const std::int64_t tiles = vertices.layout.ownCount();
    std::vector<TileFlipper::Result> parts(tiles);
    const auto farMoves = findFarMoves(vertices, interrupt);
    interrupt.expectLoops(1); // the other one takes no time
    tbb::enumerable_thread_specific<TileFlipper> flippers(
        [&] { return TileFlipper(vertices, farMoves, version >= 2); });
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        TileFlipper& flipper = flippers.local();
        for (std::int64_t t = begin; t < end; ++t) parts[t] = flipper.flip(TileRef(t));
    });

    Flips flips;
    flips.first.reserve(tiles + 1);
    flips.first.push_back(0);
    flips.suspects.emplace();
    for (const auto& part : parts) {
        if (!part.suspects.empty())
            flips.suspects->push_back(
                {TileRef(&part - parts.data()), {part.suspects[bcc::A], part.suspects[bcc::B]}});
        flips.codes.insert(flips.codes.end(), part.codes.begin(), part.codes.end());
        flips.first.push_back(std::int64_t(flips.codes.size()));
        flips.active += part.active;
        flips.extra += part.extra;
        flips.lastResort += part.lastResort;
        flips.conflicts += part.conflicts;
    }
    // Conflicts are rare, so their tiles are looked at once more instead of keeping lists for all.
    for (std::int64_t t = 0; t < tiles && flips.conflictPlaces.size() < Places::kMost; ++t) {
        if (parts[t].conflicts == 0) continue;
        TileFlipper& flipper = flippers.local();
        flipper.flip(TileRef(t));
        for (const openvdb::Vec3d& centre : flipper.conflicts()) {
            if (flips.conflictPlaces.size() < Places::kMost)
                flips.conflictPlaces.push_back(vertices.layout.origin(TileRef(t)) + centre);
        }
    }
    return flips;
}

} // namespace vdbtet
