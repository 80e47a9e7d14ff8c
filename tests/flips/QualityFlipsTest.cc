/// The flips that version 3 makes for the better angles.
#include "flips/OctahedronBatch.h"
#include "flips/Slices.h"
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/ThirdStages.h"

#include <map>
#include <set>
#include <tuple>

namespace vdbtet::test {

namespace {

/// A long edge: its lattice, axis and lower end.
using Spine = std::tuple<int, int, int, int, int>;

Spine spineAt(const openvdb::Coord& tile, int axis, int lower) {
    const int n = bitOf(lower);
    return {latticeOf(lower), axis, 8 * tile.x() + PaddedMask::x(n), 8 * tile.y() + PaddedMask::y(n),
            8 * tile.z() + PaddedMask::z(n)};
}

/// Call @a visit(tile, lattice, axis, lower end's bit, spine) for each candidate.
template <typename Visit>
void forEachCandidate(const ThirdStages& stages, Visit&& visit) {
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        for (const FlipCandidate& c : stages.flips.candidates(TileRef(t))) {
            const int kind = c.spine >> 9;
            visit(TileRef(t), bcc::Lattice(kind / 3), kind % 3, c);
        }
    }
}

} // namespace

TEST_CASE("of candidates that share a tet one flips: the one that gains most around", "[flips]") {
    std::size_t candidates = 0, rejected = 0;
    for (const auto& grid : {levelSet(noiseBall(2, Vec3d(0.1, 0.2, 0.3), 12.0, 2.0)),
                             levelSet(sphere(Vec3d(0.0), 12.3)), randomSigns(14, 2)}) {
        const ThirdStages stages(*grid);
        const Flips flips = stages.flips.flips();
        std::map<Spine, double> gains;
        std::set<Spine> flipped;
        forEachCandidate(stages, [&](TileRef t, bcc::Lattice lattice, int axis, const FlipCandidate& c) {
            gains[spineAt(stages.layout.surfaceTiles[t], axis, localIndex(lattice, c.spine & 511))] =
                double(c.gain);
        });
        for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
            flips.forEach(TileRef(t), [&](const Flip& flip) {
                flipped.insert(
                    spineAt(stages.layout.surfaceTiles[t], flip.axis, localIndex(flip.lattice, flip.vertex)));
            });
        }
        CHECK(std::int64_t(flipped.size()) == flips.active + flips.quality);
        const auto requireAlone = [&](const openvdb::Coord& tile, bcc::Lattice lattice, int axis,
                                      int vertex) {
            const LocalOctahedron o = localOctahedron(lattice, axis, localIndex(lattice, vertex));
            for (const bcc::RingEdge& edge : bcc::kRingEdges)
                REQUIRE(flipped.count(spineAt(tile, (axis + edge.axisOffset) % 3, o[edge.lower])) == 0);
        };
        for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
            flips.forEach(TileRef(t), [&](const Flip& flip) {
                requireAlone(stages.layout.surfaceTiles[t], flip.lattice, flip.axis, flip.vertex);
            });
        }
        forEachCandidate(stages, [&](TileRef t, bcc::Lattice lattice, int axis, const FlipCandidate& c) {
            const auto& tile = stages.layout.surfaceTiles[t];
            const int own = localIndex(lattice, c.spine & 511);
            const LocalOctahedron o = localOctahedron(lattice, axis, own);
            bool isLargest = true, isTied = false;
            for (const bcc::RingEdge& edge : bcc::kRingEdges) {
                const auto found = gains.find(spineAt(tile, (axis + edge.axisOffset) % 3, o[edge.lower]));
                if (found == gains.end()) continue;
                isTied = isTied || std::abs(found->second - double(c.gain)) <= kTieAngle;
                isLargest = isLargest && double(c.gain) > found->second;
            }
            const bool isFlipped = flipped.count(spineAt(tile, axis, own)) > 0;
            if (!isTied) REQUIRE(isFlipped == isLargest);
            ++candidates;
            rejected += !isFlipped;
        });
    }
    CHECK(candidates > 500);
    CHECK(rejected > 50);
}

TEST_CASE("candidates are the octahedra that gain more than 0.1 degrees and keep four tets", "[flips]") {
    const auto grid = levelSet(noiseBall(3, Vec3d(0.1, 0.2, 0.3), 11.0, 2.5));
    const ThirdStages stages(*grid);
    LocalVertices local(stages.vertices);
    std::size_t found = 0, expected = 0;
    for (std::size_t t = 0; t < stages.layout.surfaceTiles.size(); ++t) {
        local.load(TileRef(t));
        std::map<int, FlipCandidate> candidates;
        for (const FlipCandidate& c : stages.flips.candidates(TileRef(t))) candidates.emplace(c.spine, c);
        found += candidates.size();
        for (int kind = 0; kind < 6; ++kind) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                const auto lattice = bcc::Lattice(kind / 3);
                const LocalOctahedron o = localOctahedron(lattice, kind % 3, localIndex(lattice, n));
                int present = 0, manifold = 0;
                for (const int v : o) {
                    present += local.state(v) != State::Outside;
                    manifold += local.manifold(v);
                }
                const auto keepsTets = [&](bcc::Slice slice) {
                    for (const auto& tet : bcc::kSliceTets[slice]) {
                        int on = 0;
                        for (const int v : tet) on += local.manifold(o[v]);
                        if (on == 4) return false;
                    }
                    return true;
                };
                double best = 0.0;
                const double now = worth(sliceQuality(local, o, bcc::S));
                for (const bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
                    if (keepsTets(slice)) best = std::max(best, worth(sliceQuality(local, o, slice)));
                }
                const bool is = present == 6 && manifold >= 2 && keepsTets(bcc::S) && best > now + 0.1;
                if (best > 0.0 && std::abs(best - now - 0.1) < 1e-6) continue; // rounding decides
                expected += is;
                const auto candidate = candidates.find(kind << 9 | n);
                REQUIRE((candidate != candidates.end()) == is);
                if (!is) continue;
                CHECK(double(candidate->second.gain) == Approx(best - now).margin(1e-4));
                CHECK(worth(sliceQuality(local, o, bcc::Slice(candidate->second.slice))) >
                      best - 2 * kTieAngle);
            }
        }
    }
    CHECK(found == expected);
    CHECK(found > 50);
}

TEST_CASE("worth weighs sharp and wide angles, and is nothing for inverted tets", "[flips]") {
    const auto of = [](double sharpest, double widest, bool inverted) {
        SliceQuality quality;
        quality.maxCos = std::cos(sharpest * M_PI / 180);
        quality.minCos = std::cos(widest * M_PI / 180);
        quality.inverted = inverted;
        return worth(quality);
    };
    CHECK(of(20, 90, false) == Approx(20.0));
    CHECK(of(60, 130, false) == Approx(27.0));
    CHECK(of(60, 90, true) == 0.0);
}

} // namespace vdbtet::test
