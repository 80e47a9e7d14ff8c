/// The tets between octants, on random octrees: whatever the finest cells are, they fill space.
#include "grading/Octree.h"
#include "support/Catch.h"
#include "support/Fixtures.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>

namespace vdbtet::test {

using openvdb::Coord;

namespace {

enum class Cells { None, Single, Sparse, Balls, Shells, Half, AllButOne, All };
constexpr Cells kAllCells[] = {Cells::None,   Cells::Single, Cells::Sparse,    Cells::Balls,
                               Cells::Shells, Cells::Half,   Cells::AllButOne, Cells::All};
/// Those with octants of all sizes side by side.
constexpr Cells kMixedCells[] = {Cells::Sparse, Cells::Balls, Cells::Shells};

std::size_t below(Random& random, std::size_t end) { return std::size_t(random.next() % end); }

/// Three periodic balls, or the cells at their surfaces alone.
bool inBalls(const std::vector<Vec3d>& centres, double radius, bool shells, const Vec3d& at, double period) {
    return std::any_of(centres.begin(), centres.end(), [&](const Vec3d& centre) {
        Vec3d off = at - centre;
        for (int axis = 0; axis < 3; ++axis) off[axis] = std::remainder(off[axis], period);
        const double distance = off.length() - radius;
        return distance < 0.5 && (!shells || distance > -0.5);
    });
}

std::vector<TileMask> randomCells(Random& random, Cells kind, int tiles) {
    const std::size_t count = std::size_t(tiles * tiles * tiles);
    std::vector<TileMask> cells(count, TileMask::filled(kind == Cells::All || kind == Cells::AllButOne));
    const std::size_t one = below(random, count * TileMask::kSize);
    const int bit = int(one % TileMask::kSize);
    if (kind == Cells::Single) cells[one / TileMask::kSize].set(bit);
    if (kind == Cells::AllButOne) cells[one / TileMask::kSize].reset(bit);
    if (kind == Cells::Sparse || kind == Cells::Half) {
        const double density = kind == Cells::Half ? 0.5 : random.uniform(0.002, 0.02);
        for (TileMask& mask : cells) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                if (random.uniform(0.0, 1.0) < density) mask.set(n);
            }
        }
    }
    if (kind == Cells::Balls || kind == Cells::Shells) {
        const Octree box{tiles, 0, {}, {}};
        const double edge = box.edge(), radius = random.uniform(0.05, 0.25) * edge;
        std::vector<Vec3d> centres;
        for (int i = 0; i < 3; ++i) centres.push_back(random.inBox(0.0, edge));
        box.forEachTile([&](const Coord& tile) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                const Vec3d at = TileMask::kDim * tile.asVec3d() + Vec3d(n >> 6, n >> 3 & 7, n & 7);
                if (inBalls(centres, radius, kind == Cells::Shells, at, edge)) cells[box.number(tile)].set(n);
            }
        });
    }
    return cells;
}

/// The same tets, but that half-pyramids always meet at the diagonal from the lowest corner.
std::vector<OctreeTet> withoutParity(std::vector<OctreeTet> tets) {
    for (std::size_t t = 0; t < tets.size(); ++t) {
        if (tets[t].kind != TetKind::HalfPyramid) continue;
        auto& one = tets[t].points;
        auto& two = tets[++t].points; // the other half always comes next
        std::array<Coord, 4> ring = {one[1], one[2], one[3], two[3]};
        if (one[3] != two[2]) ring = {one[1], two[2], two[3], one[3]};
        std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
        one = {one[0], ring[0], ring[1], ring[2]};
        two = {one[0], ring[0], ring[2], ring[3]};
    }
    return tets;
}

/// The octrees with one octant less, which is neither a cell nor of the coarsest.
std::vector<Octree> withOneLess(const Octree& octree) {
    std::vector<Octree> result;
    const auto without = [&](std::size_t tile) -> OctantSet& {
        result.push_back(octree);
        return result.back().octants[tile];
    };
    for (std::size_t tile = 0; tile < octree.octants.size(); ++tile) {
        const OctantSet& set = octree.octants[tile];
        for (int bit = 0; bit < 64 && octree.coarsest > 1; ++bit) {
            if (set.level1 >> bit & 1) without(tile).level1 ^= std::uint64_t(1) << bit;
        }
        for (int bit = 0; bit < 8 && octree.coarsest > 2; ++bit) {
            if (set.level2 >> bit & 1) without(tile).level2 ^= std::uint8_t(1 << bit);
        }
    }
    return result;
}

} // namespace

TEST_CASE("closing octants adds the parents of all and of their face and edge neighbours", "[grading]") {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        // From a handful in 27 tiles, most of which have none, to so many that all parents exist.
        const double density = 0.0003 * std::pow(2.0, round % 10);
        std::array<TileMask, 27> masks;
        std::array<const TileMask*, 27> units{};
        std::set<Coord> cells;
        for (int slot = 0; slot < 27; ++slot) {
            for (int n = 0; n < TileMask::kSize; ++n) {
                if (random.uniform(0.0, 1.0) >= density) continue;
                masks[slot].set(n);
                cells.insert(Coord((slot / 9 - 1) * 8 + (n >> 6), (slot / 3 % 3 - 1) * 8 + (n >> 3 & 7),
                                   (slot % 3 - 1) * 8 + (n & 7)));
            }
            if (masks[slot].any()) units[slot] = &masks[slot];
        }
        const Octants expected = balanced(cells, 2, 0);
        const auto has = [&](std::size_t level, int x, int y, int z) {
            return expected[level].count(Coord(x, y, z)) > 0;
        };
        const OctantSet set = closeOctants(units);
        int wrong = set.level3 != has(3, 0, 0, 0);
        for (int n = 0; n < 64; ++n) {
            const int x = n >> 4, y = n >> 2 & 3, z = n & 3;
            wrong += set.test1(x, y, z) != has(1, x, y, z);
        }
        for (int n = 0; n < 8; ++n) {
            const int x = n >> 2, y = n >> 1 & 1, z = n & 1;
            wrong += set.test2(x, y, z) != has(2, x, y, z);
        }
        CAPTURE(round, cells.size());
        REQUIRE(wrong == 0);
    }
}

TEST_CASE("the tets of any octree fill space face to face, each of its kind", "[grading]") {
    Random random(2);
    std::map<std::pair<int, TetKind>, std::int64_t> seen;
    for (int tiles = 1; tiles <= 4; ++tiles) {
        const int rounds[] = {12, 3, 1, 1};
        for (int round = 0; round < rounds[tiles - 1]; ++round) {
            for (int coarsest = tiles < 4 ? 1 : 3; coarsest <= 3; ++coarsest) {
                for (const Cells kind : kAllCells) {
                    // In more tiles these are only more of the same.
                    if (tiles > 2 && (kind == Cells::Half || kind >= Cells::AllButOne)) continue;
                    const Octree octree = closedOctree(tiles, coarsest, randomCells(random, kind, tiles));
                    const std::vector<OctreeTet> tets = tetsOf(octree);
                    const OctreeFaults faults = faultsOf(octree, tets);
                    CAPTURE(tiles, round, coarsest, int(kind));
                    REQUIRE(faults.misshapen == 0);
                    REQUIRE(faults.volume == 0);
                    REQUIRE(faults.unmatchedFaces == 0);
                    REQUIRE(faults.wrongVertices == 0);
                    for (const OctreeTet& tet : tets) ++seen[{tet.level, tet.kind}];
                }
            }
        }
    }
    // Cells have nothing finer next to them, and octants of the coarsest level lack no neighbour.
    using Kinds = std::initializer_list<TetKind>;
    const Kinds all{TetKind::Lattice, TetKind::Bisected, TetKind::Quadrisected, TetKind::HalfPyramid};
    const Kinds ofLevel[4] = {{TetKind::Lattice, TetKind::HalfPyramid},
                              all,
                              all,
                              {TetKind::Lattice, TetKind::Bisected, TetKind::Quadrisected}};
    std::size_t expected = 0;
    for (int level = 0; level < 4; ++level) {
        for (const TetKind kind : ofLevel[level]) REQUIRE(seen[{level, kind}] > 500);
        expected += ofLevel[level].size();
    }
    REQUIRE(seen.size() == expected);
}

TEST_CASE("without finer octants there is a lattice of the coarsest", "[grading]") {
    Random random(3);
    for (int coarsest = 1; coarsest <= 3; ++coarsest) {
        const Octree octree = closedOctree(2, coarsest, randomCells(random, Cells::None, 2));
        const std::vector<OctreeTet> tets = tetsOf(octree);
        const std::size_t edge = std::size_t(octree.edge() >> coarsest);
        REQUIRE(tets.size() == 12 * edge * edge * edge);
        REQUIRE(std::all_of(tets.begin(), tets.end(), [&](const OctreeTet& tet) {
            return tet.kind == TetKind::Lattice && tet.level == coarsest;
        }));
    }
}

TEST_CASE("balance over faces alone leaves holes", "[grading]") {
    Random random(4);
    for (int round = 0; round < 8; ++round) {
        for (const Cells kind : kMixedCells) {
            const std::vector<TileMask> cells = randomCells(random, kind, 2);
            const auto fillsSpace = [&](int reach) {
                const Octree octree = balancedOctree(2, 3, cells, reach);
                return faultsOf(octree, tetsOf(octree)).fillsSpace();
            };
            CAPTURE(round, int(kind));
            REQUIRE(fillsSpace(2));
            REQUIRE_FALSE(fillsSpace(1));
        }
    }
}

TEST_CASE("half-pyramids all cut alike do not fit", "[grading]") {
    Random random(5);
    for (int round = 0; round < 4; ++round) {
        for (const Cells kind : kMixedCells) {
            const Octree octree = closedOctree(2, 3, randomCells(random, kind, 2));
            const OctreeFaults faults = faultsOf(octree, withoutParity(tetsOf(octree)));
            CAPTURE(round, int(kind));
            REQUIRE(faults.misshapen == 0);
            REQUIRE(faults.volume == 0);
            REQUIRE(faults.unmatchedFaces > 0);
        }
    }
}

TEST_CASE("every octant that balance adds is necessary", "[grading]") {
    Random random(6);
    for (const Cells kind : kMixedCells) {
        const Octree whole = closedOctree(2, 3, randomCells(random, kind, 2));
        const std::vector<Octree> octrees = withOneLess(whole);
        REQUIRE(octrees.size() > 10);
        for (std::size_t i = 0; i < octrees.size(); i += 4) {
            CAPTURE(int(kind), i);
            REQUIRE_FALSE(faultsOf(octrees[i], tetsOf(octrees[i])).fillsSpace());
        }
    }
}

} // namespace vdbtet::test
