/// @file QualityFlips.cc
/// Octahedra found by masks, judged in lanes; one round over frozen candidates.
#include "flips/QualityFlips.h"

#include "flips/OctahedronBatch.h"
#include "flips/Slices.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace vdbtet {

namespace {

constexpr double kLeastGain = 0.1; // degrees

/// Finds the active spines and the candidates of one tile after another.
class CandidateFinder {
public:
    explicit CandidateFinder(const Vertices& vertices) : mVertices(vertices), mLocal(vertices) {}

    void find(TileRef tile, std::vector<std::uint16_t>& active, std::vector<FlipCandidate>& candidates) {
        active.clear();
        candidates.clear();
        if (!nearManifold(tile)) return;
        mLocal.load(tile);
        mPositions.load(mVertices, tile);
        mActive.clear();
        mOctahedra.clear();
        mCandidates = &candidates;
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            for (int axis = 0; axis < 3; ++axis) findAlong(lattice, axis);
        }
        judge();
        chooseActiveSlices(mLocal, mOctahedra, SliceRule::Worth, mSlices);
        for (std::size_t i = 0; i < mActive.size(); ++i) {
            mActive[i].slice = mSlices[i];
            active.push_back(Flips::encode(mActive[i]));
        }
        std::sort(active.begin(), active.end());
    }

private:
    bool nearManifold(TileRef tile) const {
        for (TileRef from : mVertices.layout.neighbours[tile]) {
            if (from >= 0 && mVertices.destinations.any(from)) return true;
        }
        return false;
    }

    void findAlong(bcc::Lattice lattice, int axis) {
        TileMask interior[6], manifold[6];
        for (int v = 0; v < 6; ++v) {
            const bcc::Vertex& at = bcc::kOctahedra[lattice][axis][v];
            interior[v] = mLocal.interiorMask(at.lattice).shifted(at.x, at.y, at.z);
            manifold[v] = mLocal.manifoldMask(at.lattice).shifted(at.x, at.y, at.z);
        }
        const TileMask active = (interior[0] ^ interior[1]) & ~(manifold[0] | manifold[1]);
        active.forEach([&](int n) {
            mActive.push_back({lattice, axis, bcc::S, n});
            mOctahedra.push_back(localOctahedron(lattice, axis, localIndex(lattice, n)));
        });
        TileMask all = interior[0] | manifold[0], one = manifold[0], two;
        for (int v = 1; v < 6; ++v) {
            all &= interior[v] | manifold[v];
            two |= one & manifold[v];
            one |= manifold[v];
        }
        // No tet that is there now is ambiguous.
        const TileMask spine = manifold[0] & manifold[1];
        for (int r = 0; r < 4; ++r) all &= ~(spine & manifold[2 + r] & manifold[2 + (r + 1) % 4]);
        (all & two).forEach([&](int n) {
            mSpines.push_back(std::uint16_t((lattice * 3 + axis) << 9 | n));
            mBatch.set(int(mSpines.size()) - 1, mPositions,
                       localOctahedron(lattice, axis, localIndex(lattice, n)));
            if (int(mSpines.size()) == OctahedronBatch::kLanes) judge();
        });
    }

    /// Judge the octahedra collected.
    void judge() {
        if (mSpines.empty()) return;
        mBatch.judge();
        for (int lane = 0; lane < int(mSpines.size()); ++lane) {
            if (!mBatch.mayGain(lane)) continue;
            const int spine = mSpines[std::size_t(lane)];
            const auto octahedron = localOctahedron(bcc::Lattice(spine / (3 << 9)), (spine >> 9) % 3,
                                                    localIndex(spine / (3 << 9), spine & 511));
            const double now = mBatch.worthOf(bcc::S, lane);
            double best = now + kLeastGain;
            bcc::Slice slice = bcc::S;
            for (const bcc::Slice other : {bcc::SliceA, bcc::SliceB}) {
                const double then = mBatch.worthOf(other, lane);
                if (!(then > best + (slice == bcc::S ? 0.0 : kTieAngle))) continue;
                if (isAmbiguous(octahedron, other)) continue;
                best = then;
                slice = other;
            }
            if (slice == bcc::S) continue;
            mCandidates->push_back({std::uint16_t(spine), std::uint8_t(slice), float(best - now)});
        }
        mSpines.clear();
    }

    /// Whether a slice has tets of four manifold vertices.
    bool isAmbiguous(const LocalOctahedron& octahedron, bcc::Slice slice) const {
        return std::any_of(std::begin(bcc::kSliceTets[slice]), std::end(bcc::kSliceTets[slice]),
                           [&](const auto& tet) {
                               return std::all_of(std::begin(tet), std::end(tet),
                                                  [&](int v) { return mLocal.manifold(octahedron[v]); });
                           });
    }

    const Vertices& mVertices;
    LocalVertices mLocal;
    LocalPositions mPositions;
    std::vector<Flip> mActive;
    std::vector<LocalOctahedron> mOctahedra; ///< of mActive
    std::vector<bcc::Slice> mSlices;         ///< for mOctahedra
    std::vector<FlipCandidate>* mCandidates = nullptr;
    std::vector<std::uint16_t> mSpines; ///< of the octahedra in mBatch
    OctahedronBatch mBatch;
};

int spineOf(std::uint16_t code) {
    const Flip flip = Flips::decode(code);
    return (flip.lattice * 3 + flip.axis) << 9 | flip.vertex;
}
int spineOf(const FlipCandidate& candidate) { return candidate.spine; }
int orderOf(std::uint16_t code) { return code; }
int orderOf(const FlipCandidate& candidate) { return candidate.spine; }

/// Mark the lower ends of what is in one of two ascending lists only.
template <typename Item>
void markDifference(const std::vector<Item>& before, const std::vector<Item>& now,
                    std::array<TileMask, 2>& changed) {
    const auto mark = [&](const Item& item) {
        const int spine = spineOf(item);
        changed[std::size_t(spine / (3 << 9))].set(spine & 511);
    };
    auto a = before.begin(), b = now.begin();
    while (a != before.end() || b != now.end()) {
        const bool hasA = a != before.end(), hasB = b != now.end();
        if (hasA && hasB && *a == *b) {
            ++a, ++b;
        } else if (hasA && (!hasB || orderOf(*a) <= orderOf(*b))) {
            mark(*a++);
        } else {
            mark(*b++);
        }
    }
}

/// Put a list in another one's place, in as little memory.
template <typename Item>
void replace(std::vector<Item>& list, const std::vector<Item>& now, std::array<TileMask, 2>& changed) {
    markDifference(list, now, changed);
    list.assign(now.begin(), now.end());
}

} // namespace

QualityFlips::QualityFlips(const Vertices& vertices)
    : mVertices(vertices), mTiles(vertices.layout.surfaceTiles.size()) {}

void QualityFlips::choose(const std::vector<TileRef>& tiles, VertexMasks& changed, Interrupt& interrupt,
                          const Seams& seams) {
    VertexMasks turned(mTiles.size());
    tbb::enumerable_thread_specific<CandidateFinder> finders([&] { return CandidateFinder(mVertices); });
    seams.together([&] {
        parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
            CandidateFinder& finder = finders.local();
            std::vector<std::uint16_t> active;
            std::vector<FlipCandidate> candidates;
            for (std::int64_t i = begin; i < end; ++i) {
                finder.find(tiles[i], active, candidates);
                replace(mTiles[tiles[i]].active, active, changed[tiles[i]]);
                replace(mTiles[tiles[i]].candidates, candidates, turned[tiles[i]]);
            }
        });
    });
    if (interrupt.stopped()) return;
    seams.exchange(
        [&](TileRef t, Bytes& bytes) {
            packList(bytes, mTiles[t].active);
            packList(bytes, mTiles[t].candidates);
        },
        [&](TileRef t, Unpacker& next) {
            replace(mTiles[t].active, next.nextList<std::uint16_t>(), changed[t]);
            replace(mTiles[t].candidates, next.nextList<FlipCandidate>(), turned[t]);
        });
    seams.together([&] {
        const std::vector<TileRef> near = tilesNear(mVertices.layout, turned, interrupt);
        parallelRanges(std::int64_t(near.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
            std::vector<std::uint16_t> chosen;
            for (std::int64_t i = begin; i < end; ++i) {
                chosen.clear();
                for (const FlipCandidate& c : mTiles[near[i]].candidates) {
                    if (!wins(near[i], c)) continue;
                    const int kind = c.spine >> 9;
                    chosen.push_back(Flips::encode(
                        {bcc::Lattice(kind / 3), kind % 3, bcc::Slice(c.slice), c.spine & 511}));
                }
                std::sort(chosen.begin(), chosen.end());
                replace(mTiles[near[i]].chosen, chosen, changed[near[i]]);
            }
        });
    });
    seams.exchange([&](TileRef t, Bytes& bytes) { packList(bytes, mTiles[t].chosen); },
                   [&](TileRef t, Unpacker& next) {
                       replace(mTiles[t].chosen, next.nextList<std::uint16_t>(), changed[t]);
                   });
}

void QualityFlips::chooseAll(Interrupt& interrupt, const Seams& seams) {
    std::vector<TileRef> tiles(std::size_t(mVertices.layout.ownCount()));
    std::iota(tiles.begin(), tiles.end(), 0);
    VertexMasks changed(mTiles.size());
    choose(tiles, changed, interrupt, seams);
}

bool QualityFlips::wins(TileRef tile, const FlipCandidate& candidate) const {
    const int kind = candidate.spine >> 9, axis = kind % 3;
    const auto lattice = bcc::Lattice(kind / 3), across = bcc::other(lattice);
    const int own = localIndex(lattice, candidate.spine & 511);
    const LocalOctahedron octahedron = localOctahedron(lattice, axis, own);
    for (const bcc::RingEdge& edge : bcc::kRingEdges) {
        const int n = bitOf(octahedron[edge.lower]);
        const int x = PaddedMask::x(n), y = PaddedMask::y(n), z = PaddedMask::z(n);
        const TileRef from =
            mVertices.layout.neighbours[tile][neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
        if (from < 0) continue;
        const FlipCandidate* other =
            find(from, std::uint16_t((across * 3 + (axis + edge.axisOffset) % 3) << 9 |
                                     TileMask::bit(x & 7, y & 7, z & 7)));
        if (!other) continue;
        const double more = double(candidate.gain) - double(other->gain);
        const bool isFirst = bitOf(own) != n ? bitOf(own) < n : lattice == bcc::A;
        if (std::abs(more) <= kTieAngle ? !isFirst : more < 0.0) return false;
    }
    return true;
}

const FlipCandidate* QualityFlips::find(TileRef tile, std::uint16_t spine) const {
    const auto& all = mTiles[tile].candidates;
    const auto found = std::lower_bound(all.begin(), all.end(), spine,
                                        [](const FlipCandidate& c, std::uint16_t s) { return c.spine < s; });
    return found != all.end() && found->spine == spine ? &*found : nullptr;
}

Flips QualityFlips::flips() const {
    Flips flips;
    flips.first.reserve(mTiles.size() + 1);
    flips.first.push_back(0);
    for (const OfTile& tile : mTiles) {
        std::merge(tile.active.begin(), tile.active.end(), tile.chosen.begin(), tile.chosen.end(),
                   std::back_inserter(flips.codes));
        flips.first.push_back(std::int64_t(flips.codes.size()));
        if (std::int64_t(flips.first.size()) - 1 > mVertices.layout.ownCount()) continue;
        flips.active += std::int64_t(tile.active.size());
        flips.quality += std::int64_t(tile.chosen.size());
    }
    return flips;
}

} // namespace vdbtet
