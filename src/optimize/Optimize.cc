/// @file Optimize.cc
/// Sweeps over the vertices whose tets are not good enough.
#include "optimize/Optimize.h"

#include "optimize/PoorTets.h"
#include "optimize/VertexStep.h"
#include "tets/Stars.h"
#include "tets/TileTets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace vdbtet {

using openvdb::Vec3d;
using openvdb::Vec3f;

namespace {

/// Tiles of one parity of coordinates are no neighbours.
constexpr int kParities = 8;

int parityOf(const openvdb::Coord& tile) {
    return (tile.x() & 1) << 2 | (tile.y() & 1) << 1 | (tile.z() & 1);
}

/// Vertices in and around a tile.
using Marks = std::array<PaddedMask, 2>;

void mark(Marks& marks, int local) { marks[latticeOf(local)].set(bitOf(local)); }

/// @brief Add marks to the masks of their tiles; several threads at a time may.
/// @param among  only those in these masks, if any
void scatter(const Marks& marks, const Neighbours& neighbours, VertexMasks& masks,
             const VertexMasks* among = nullptr) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        marks[lattice].forEach([&](int n) {
            const int x = PaddedMask::x(n), y = PaddedMask::y(n), z = PaddedMask::z(n);
            const TileRef tile = neighbours[neighbourSlot(tileStep(x), tileStep(y), tileStep(z))];
            if (tile < 0) return;
            std::uint64_t bit = std::uint64_t(1) << TileMask::bit(0, y & 7, z & 7);
            if (among) bit &= (*among)[tile][lattice].words[x & 7];
            if (bit == 0) return;
            __atomic_fetch_or(&masks[tile][lattice].words[x & 7], bit, __ATOMIC_RELAXED);
        });
    }
}

/// The vertices that may move: the manifold ones, and those inside next to one.
void findMovable(const Vertices& vertices, TileRef tile, LocalStates& states,
                 std::array<TileMask, 2>& movable) {
    states.load(vertices, tile);
    for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
        movable[lattice] = states.manifoldMask(lattice).core() |
                           (states.interiorMask(lattice).core() & nextTo(states.manifoldMasks(), lattice));
    }
}

/// Number the offsets, and let all vertices be at their destinations.
Moves startMoves(const Vertices& vertices, Interrupt& interrupt, const Seams& seams) {
    Moves moves;
    const std::int64_t count = vertices.layout.surfaceCount(), own = vertices.layout.ownCount();
    moves.moved.resize(std::size_t(count));
    parallelRanges(own, interrupt, [&](std::int64_t begin, std::int64_t end) {
        LocalStates states;
        for (std::int64_t t = begin; t < end; ++t) findMovable(vertices, TileRef(t), states, moves.moved[t]);
    });
    seams.exchange(moves.moved);
    moves.offsets.assign(std::size_t(moves.number()), Vec3f(0.0f));
    parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            for (int lattice = 0; lattice < 2; ++lattice) {
                std::int64_t move = vertices.firstMove(TileRef(t), lattice);
                const TileMask& moved = moves.moved[t][lattice];
                vertices.moved(TileRef(t), lattice).forEach([&](int n) {
                    moves.offsets[moves.first[t][lattice] + moved.rank(n)] = Vec3f(vertices.move(move++));
                });
            }
        }
    });
    return moves;
}

/// Finds the vertices of the tets that are not good enough; one for each thread.
class PoorMarker {
public:
    PoorMarker(const Vertices& vertices, const Flips& flips, double quality)
        : mVertices(vertices), mTets(vertices, flips), mPoor(quality) {}

    /// Mark those of the tets that @a tile owns.
    void find(TileRef tile, VertexMasks& masks) {
        mStates.load(mVertices, tile);
        if (!mStates.manifoldMask(bcc::A).any() && !mStates.manifoldMask(bcc::B).any()) return;
        mTets.load(tile, mStates);
        mTets.change(mVertices.changesOf(tile));
        mPositions.load(mVertices, tile);
        Marks marks;
        const auto markAll = [&](const std::array<int, 4>& ids) {
            for (const int id : ids) mark(marks, id);
        };
        const auto add = [&](const std::array<int, 4>& v) {
            mPoor.add(v, {mPositions[v[0]], mPositions[v[1]], mPositions[v[2]], mPositions[v[3]]}, markAll);
        };
        const auto addFlipped = [&](const LocalTet& tet) {
            add({tet.vertex(0), tet.vertex(1), tet.vertex(2), tet.vertex(3)});
        };
        for (int axis = 0; axis < 3; ++axis) {
            const LocalOctahedron o = localOctahedron(bcc::A, axis, 0);
            for (int number = 0; number < 4; ++number) {
                const auto& tet = bcc::kSliceTets[bcc::S][number];
                TileMask some; // all others are the lattice's own
                for (const int v : tet) some |= mTets.manifold(axis, v);
                some &= mTets.latticeTets(axis, number);
                some.forEach([&](int n) {
                    const int base = localIndex(bcc::A, n);
                    add({base + o[tet[0]], base + o[tet[1]], base + o[tet[2]], base + o[tet[3]]});
                });
            }
            mTets.flippedSpines(axis).forEach([&](int n) { mTets.forEachTetOf(axis, n, addFlipped); });
        }
        mTets.forEachTetOfB(addFlipped);
        mPoor.flush(markAll);
        scatter(marks, mVertices.layout.neighbours[tile], masks);
    }

    AngleRange range() const { return {angleOfSquare(mPoor.most()), angleOfSquare(mPoor.least())}; }

private:
    const Vertices& mVertices;
    LocalStates mStates;
    TileTets mTets;
    LocalPositions mPositions;
    PoorTets mPoor;
};

/// What the sweeps know of the vertices of each surface tile.
struct SweepState {
    VertexMasks dirty;   ///< to be looked at
    VertexMasks stuck;   ///< looked at in vain; worth another look when a neighbour has moved
    VertexMasks changed; ///< have been moved
};

/// Moves the vertices of one tile after another; one for each thread.
class TileSweeper {
public:
    TileSweeper(const Field& field, const Vertices& vertices, const Flips& flips, const StepGoals& goals)
        : mVertices(vertices), mStars(vertices, flips), mGoal(goals.quality), mStep(field.probe(), goals) {}

    /// @param moves  those of the vertices; offsets of this tile's are changed
    /// @param state  of all tiles; of others, dirty vertices are added
    void sweep(TileRef tile, Moves& moves, SweepState& state) {
        const std::array<TileMask, 2>& movable = moves.moved[tile];
        mMaybe = {};
        for (int lattice = 0; lattice < 2; ++lattice)
            mDirty[lattice] = padded(state.dirty[tile][lattice] & movable[lattice]);
        const Neighbours& neighbours = mVertices.layout.neighbours[tile];
        mStates.load(mVertices, tile);
        mStars.load(tile, mStates);
        mPositions.load(mVertices, tile);
        const openvdb::Coord& at = mVertices.layout.surfaceTiles[tile];
        const Vec3d origin(8.0 * at.x(), 8.0 * at.y(), 8.0 * at.z());
        for (int lattice = 0; lattice < 2; ++lattice) {
            TileMask& stuck = state.stuck[tile][lattice];
            movable[lattice].forEach([&](int n) {
                const int v = localIndex(lattice, n), bit = bitOf(v);
                if (!mDirty[lattice].test(bit) && !(mMaybe[lattice].test(bit) && stuck.test(n))) return;
                mDirty[lattice].remove(bit);
                mMaybe[lattice].remove(bit);
                stuck.reset(n);
                bool slides;
                if (!load(v, slides)) return;
                const Vec3d home = homeOf(v);
                Vec3f& offset = moves.offsets[moves.first[tile][lattice] + movable[lattice].rank(n)];
                const VertexStep::Outcome outcome = mStep.improve(mBall, slides, origin, home, offset);
                if (outcome == VertexStep::Outcome::Stuck) stuck.set(n);
                if (outcome != VertexStep::Outcome::Moved) return;
                state.changed[tile][lattice].set(n);
                mPositions.move(v, home + Vec3d(offset));
                markBall(v);
            });
        }
        for (int lattice = 0; lattice < 2; ++lattice) {
            state.dirty[tile][lattice] =
                mDirty[lattice].core() | (mMaybe[lattice].core() & state.stuck[tile][lattice]);
            mDirty[lattice].remove(kCore);
            mMaybe[lattice].remove(kCore);
        }
        scatter(mDirty, neighbours, state.dirty);
        scatter(mMaybe, neighbours, state.dirty, &state.stuck);
    }

private:
    /// A vertex of the ball is worth a look if it is in a tet that is not good enough, or was stuck.
    void markBall(int v) {
        for (int i = 0; i < mBall.size(); ++i) {
            Marks& marks = mBall.quality(i) < mGoal ? mDirty : mMaybe;
            for (const int w : mBall.face(i)) mark(marks, w);
            mark(marks, v);
        }
    }

    static PaddedMask padded(const TileMask& mask) {
        MasksAround around;
        around.masks.fill(&kNone);
        around.masks[neighbourSlot(0, 0, 0)] = &mask;
        return PaddedMask(around);
    }

    /// Gather the tets at a vertex.
    /// @return whether it may move, and then whether it must stay on the surface
    bool load(int v, bool& slides) {
        // Even permutations that bring each vertex of a tet to the front.
        constexpr int kOrder[4][3] = {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}};
        mBall.clear();
        bool full = true;
        mStars.forEachTet(v, [&](const StarTet& tet) {
            if (tet.presence != Presence::InMesh) {
                full = false;
                return;
            }
            const auto& ids = tet.vertices;
            const auto& order = kOrder[std::find(ids.begin(), ids.end(), v) - ids.begin()];
            const Ball::Face face{ids[order[0]], ids[order[1]], ids[order[2]]};
            mBall.add(face, mPositions[face[0]], mPositions[face[1]], mPositions[face[2]]);
        });
        mBall.complete();
        slides = !full;
        return mBall.size() > 0 && (full || mStates.manifold(v));
    }

    static inline const TileMask kNone;
    static inline const PaddedMask kCore = PaddedMask::filledCore();

    const Vertices& mVertices;
    LocalStates mStates;
    Stars mStars;
    LocalPositions mPositions;
    Ball mBall;
    Marks mDirty; ///< vertices in and around the tile
    Marks mMaybe; ///< the same if they are stuck
    double mGoal;
    VertexStep mStep;
};

/// Tell the other parts what the tiles of one parity have done, and get what theirs have.
void shareTurn(const Seams& seams, const Layout& layout, int parity, Moves& moves, SweepState& state) {
    const auto isOfTurn = [&](TileRef t) { return parityOf(layout.surfaceTiles[t]) == parity; };
    // What is left to do in a tile of this turn its own part knows alone; in all others any may have marked.
    for (std::int64_t t = layout.ownCount(); t < layout.surfaceCount(); ++t) {
        if (isOfTurn(TileRef(t))) state.dirty[t] = {};
    }
    seams.unite(state.dirty);
    const auto forEach = [&](TileRef t, const auto& visit) {
        if (!isOfTurn(t)) return;
        visit(&state.stuck[t], 1);
        const std::int64_t begin = moves.first[t][bcc::A], end = moves.first[t + 1][bcc::A];
        visit(moves.offsets.data() + begin, std::size_t(end - begin));
    };
    seams.exchange(
        [&](TileRef t, Bytes& bytes) {
            forEach(t, [&](const auto* from, std::size_t size) { pack(bytes, from, size); });
        },
        [&](TileRef t, Unpacker& next) { forEach(t, [&](auto* to, std::size_t size) { next(to, size); }); });
}

/// Forget the offsets of vertices inside that never moved.
void compact(const Vertices& vertices, const VertexMasks& changed, Moves& moves) {
    std::int64_t from = 0, to = 0;
    for (std::size_t t = 0; t < moves.moved.size(); ++t) {
        for (int lattice = 0; lattice < 2; ++lattice) {
            const TileMask kept = vertices.moved(TileRef(t), lattice) | changed[t][lattice];
            moves.moved[t][lattice].forEach([&](int n) {
                if (kept.test(n)) moves.offsets[to++] = moves.offsets[from];
                ++from;
            });
            moves.moved[t][lattice] = kept;
        }
    }
    moves.offsets.resize(std::size_t(moves.number()));
}

/// A sweep finds about a third of the last one's work.
int percentAfter(double sweeps) { return int(100.0 * (1.0 - std::pow(3.0, -sweeps))); }

} // namespace

Optimized optimize(const Field& field, const Vertices& vertices, const Flips& flips,
                   const OptimizeOptions& options, Interrupt& interrupt, const Seams& seams) {
    const double sine = std::sin(options.target / 57.295779513082320877);
    const StepGoals goals{sine * sine, options.tolerance};
    Optimized result;
    Moves& moves = result.moves;
    moves = startMoves(vertices, interrupt, seams);
    Vertices current = vertices;
    current.moves = &moves;
    const std::int64_t count = vertices.layout.ownCount();
    const VertexMasks none(vertices.layout.surfaceTiles.size());
    SweepState state{none, none, none};

    tbb::enumerable_thread_specific<std::unique_ptr<PoorMarker>> markers(
        [&] { return std::make_unique<PoorMarker>(current, flips, goals.quality); });
    seams.together([&] {
        parallelRanges(count, interrupt, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t t = begin; t < end; ++t) markers.local()->find(TileRef(t), state.dirty);
        });
    });
    seams.unite(state.dirty);
    for (const auto& marker : markers) {
        result.before.min = std::min(result.before.min, marker->range().min);
        result.before.max = std::max(result.before.max, marker->range().max);
    }

    tbb::enumerable_thread_specific<std::unique_ptr<TileSweeper>> sweepers(
        [&] { return std::make_unique<TileSweeper>(field, current, flips, goals); });
    for (; result.sweeps < options.sweeps; ++result.sweeps) {
        bool any = false;
        for (int parity = 0; parity < kParities; ++parity) {
            if (interrupt.poll(percentAfter(result.sweeps + double(parity) / kParities))) return result;
            std::vector<TileRef> tiles;
            for (std::int64_t t = 0; t < count; ++t) {
                if (parityOf(vertices.layout.surfaceTiles[t]) != parity) continue;
                const auto& masks = state.dirty[t];
                if (masks[0].any() || masks[1].any()) tiles.push_back(TileRef(t));
            }
            if (!seams.any(!tiles.empty())) continue;
            any = true;
            seams.together([&] {
                const auto size = std::int64_t(tiles.size());
                parallelRanges(size, interrupt, [&](std::int64_t begin, std::int64_t end) {
                    TileSweeper& sweeper = *sweepers.local();
                    for (std::int64_t i = begin; i < end; ++i) sweeper.sweep(tiles[i], moves, state);
                });
            });
            shareTurn(seams, vertices.layout, parity, moves, state);
        }
        if (!any) break;
    }
    if (interrupt.stopped()) return result;
    for (std::int64_t t = 0; t < count; ++t)
        result.verticesMoved += state.changed[t][0].count() + state.changed[t][1].count();
    seams.sum(result.verticesMoved);
    seams.exchange(state.changed);
    compact(vertices, state.changed, moves);
    return result;
}

} // namespace vdbtet
