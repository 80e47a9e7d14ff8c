/// Every instruction set gives the same bytes.
#include "support/Catch.h"
#include "support/Fixtures.h"
#include "support/Stages.h"

#include "destinations/Destinations.h"
#include "field/Root.h"
#include "field/VoxelBlock.h"
#include "field/VoxelCube.h"
#include "flips/Slices.h"
#include "flips/Suspects.h"
#include "quality/AngleSum.h"

#include <cstring>

namespace vdbtet::test {

namespace {

std::vector<Isa> vectorSets() {
    std::vector<Isa> sets;
    for (Isa isa : {Isa::Avx2, Isa::Avx512}) {
        if (supports(isa)) sets.push_back(isa);
    }
    if (sets.empty()) WARN("no vector instructions here: only the plain path is tested");
    return sets;
}

/// Values near a plane with noise of any scale, exact zeros among them.
std::vector<float> voxels(Random& random, double noise) {
    std::vector<float> values(27 * 512);
    for (auto& value : values) {
        value = float(random.uniform(-1.0, 1.0) * noise);
        if (random.next() % 64 == 0) value = 0.0f;
    }
    return values;
}

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

struct BlockResult {
    PaddedMask a, b;
    PaddedEdgeMasks nearer;
    std::vector<float> distances[2];

    BlockResult(const std::vector<float>& values, const Level& level, double tau, Isa isa) {
        std::array<const float*, 27> leaves;
        for (int slot = 0; slot < 27; ++slot) leaves[slot] = values.data() + 512 * slot;
        VoxelBlock block(isa);
        block.load(leaves, level);
        block.signs(a, b);
        PaddedEdgeMasks edges;
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(bcc::A, d);
            for (int n = 0; n < TileMask::kSize; ++n) {
                const int vertex = PaddedMask::bit(n);
                if (a.test(vertex) != b.test(vertex + PaddedMask::step(step.x, step.y, step.z)))
                    edges[d].set(vertex);
            }
        }
        block.nearerToA(edges, tau, nearer);
        std::vector<ShortEdge> nearEdges[2];
        for (int d = 0; d < bcc::kDirections; ++d) {
            const bcc::Step step = bcc::shortEdge(bcc::A, d);
            edges[d].forEach([&](int n) {
                const int end = n + PaddedMask::step(step.x, step.y, step.z);
                const bool halved = n % 3 == 0;
                if (nearer[d].test(n)) {
                    nearEdges[bcc::A].push_back({std::uint16_t(n), std::uint8_t(d), halved});
                } else if (std::min({PaddedMask::x(end), PaddedMask::y(end), PaddedMask::z(end)}) >= 0) {
                    nearEdges[bcc::B].push_back({std::uint16_t(end), std::uint8_t(bcc::opposite(d)), halved});
                }
            });
        }
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            distances[lattice].resize(nearEdges[lattice].size());
            block.cutPoints(lattice, nearEdges[lattice], tau, distances[lattice].data());
        }
    }
};

} // namespace

TEST_CASE("signs and cut points are the same on every instruction set", "[simd]") {
    Random random(1);
    const std::vector<Isa> sets = vectorSets();
    for (const double noise : {1.0, 1e-6, 1e30}) {
        for (const bool below : {false, true}) {
            const double tau = below ? 0.7 : 0.5;
            const std::vector<float> values = voxels(random, noise);
            const BlockResult plain(values, Level{0.1 * noise, below}, tau, Isa::Plain);
            REQUIRE(plain.distances[bcc::A].size() > 300);
            REQUIRE(plain.distances[bcc::B].size() > 300);
            for (Isa isa : sets) {
                const BlockResult other(values, Level{0.1 * noise, below}, tau, isa);
                REQUIRE(other.a.core() == plain.a.core());
                REQUIRE(other.b.core() == plain.b.core());
                for (int d = 0; d < bcc::kDirections; ++d)
                    REQUIRE(other.nearer[d].core() == plain.nearer[d].core());
                for (int lattice = 0; lattice < 2; ++lattice)
                    REQUIRE(sameBytes(other.distances[lattice], plain.distances[lattice]));
            }
        }
    }
}

TEST_CASE("nearer ends of all edges of a cube are those of each edge", "[simd]") {
    Random random(3);
    for (const double tau : {0.5, 0.7}) {
        int cut = 0;
        for (int i = 0; i < 2000; ++i) {
            double block[PaddedMask::step(1, 1, 1) + 1];
            for (double& value : block) value = random.uniform(-1.0, 1.0);
            const VoxelCube cube(block);
            VoxelCube::Corners corners;
            tau == 0.5 ? cube.nearer<true>(tau, corners) : cube.nearer<false>(tau, corners);
            for (int corner = 0; corner < 8; ++corner) {
                double p[8];
                for (int k = 0; k < 8; ++k) {
                    const int from = k ^ corner; // which is where the edge starts for 0
                    p[k] = block[PaddedMask::step(from >> 2, from >> 1 & 1, from & 1)];
                }
                const Diagonal phi = Diagonal::of(p);
                const bool isCut = (phi(0.0) >= 0.0) != (phi(1.0) >= 0.0);
                const double middle = phi(reachOf(phi(0.0), tau));
                INFO("corner " << corner << ", " << middle);
                REQUIRE((corners[corner] != 0) == (isCut && cutInFirstPart(phi(0.0), middle, phi(1.0))));
                cut += isCut;
            }
        }
        REQUIRE(cut > 3000);
    }
}

TEST_CASE("cut points in lanes are those of the root finder", "[simd]") {
    Random random(2);
    CutEdges edges;
    std::vector<float> expected, found(CutEdges::kLanes);
    for (const bool nearIsB : {false, true}) {
        for (int batch = 0; batch < 50; ++batch) {
            edges.count = 0;
            expected.clear();
            while (edges.count < 1 + batch % CutEdges::kLanes) {
                // From nearly straight to anything.
                const double slope = random.uniform(0.0, 3.0), noise = random.uniform(0.0, 1.0);
                double p[8];
                for (int i = 0; i < 8; ++i) {
                    p[i] = slope * ((i >> 2) + (i >> 1 & 1) + (i & 1) - 1.0) / 3.0 +
                           noise * random.uniform(-1.0, 1.0);
                }
                const Diagonal phi = Diagonal::of(p);
                const double near = nearIsB ? centreValue(p) : p[0];
                const double tau = batch % 2 ? 0.7 : 0.5;
                edges.add(phi, near, tau);
                expected.push_back(distanceToCut(near, reachOf(near, tau),
                                                 [&](double s) { return phi(nearIsB ? 1.0 - s : s); }));
            }
            found.resize(expected.size());
            distancesToCuts(edges, nearIsB, found.data(), bestIsa());
            for (std::size_t i = 0; i < found.size(); ++i) REQUIRE(std::abs(found[i] - expected[i]) < 1e-7f);
        }
    }
}

TEST_CASE("angles are summed up the same on every instruction set", "[simd]") {
    for (int tets : {1, 63, 64, 65, 1000}) {
        const auto sum = [tets](Isa isa) {
            Random random(3);
            AngleSum angles(isa);
            for (int i = 0; i < tets; ++i) {
                Vec3d p[4];
                for (auto& v : p) v = random.inBox(-1, 1);
                angles.add(p[0], p[1], p[2], p[3]);
            }
            return angles;
        };
        const AngleStats plain = sum(Isa::Plain).stats();

        Random random(3);
        AngleStats expected;
        for (int i = 0; i < tets; ++i) {
            Vec3d p[4];
            for (auto& v : p) v = random.inBox(-1, 1);
            for (double angle : dihedralAngles(p[0], p[1], p[2], p[3])) {
                expected.min = std::min(expected.min, angle);
                expected.max = std::max(expected.max, angle);
                ++expected.histogram[size_t(angle / 10.0)];
            }
        }
        REQUIRE(plain.histogram == expected.histogram);
        REQUIRE(plain.min == Approx(expected.min).margin(1e-6));
        REQUIRE(plain.max == Approx(expected.max).margin(1e-6));
        for (Isa isa : vectorSets()) {
            AngleSum vectors = sum(isa);
            const AngleStats other = vectors.stats();
            REQUIRE(vectors.percentiles().low == sum(Isa::Plain).percentiles().low);
            REQUIRE(vectors.percentiles().high == sum(Isa::Plain).percentiles().high);
            REQUIRE(other.min == plain.min);
            REQUIRE(other.max == plain.max);
            REQUIRE(other.histogram == plain.histogram);
        }
    }
}

TEST_CASE("percentiles are those of the sorted angles", "[simd]") {
    Random random(5);
    AngleSum sum;
    std::vector<double> angles;
    for (int i = 0; i < 20000; ++i) {
        // Mostly fair tets, and some of all sorts.
        const double spread = i % 50 == 0 ? 1.0 : 0.2;
        Vec3d p[4] = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0.5, 0.9, 0), Vec3d(0.5, 0.3, 0.8)};
        for (auto& v : p) v += random.inBox(-spread, spread);
        sum.add(p[0], p[1], p[2], p[3]);
        for (double angle : dihedralAngles(p[0], p[1], p[2], p[3])) angles.push_back(angle);
    }
    constexpr std::array<int, 6> kKnown{60, 60, 60, 60, 90, 90};
    sum.addLatticeTets(20000);
    for (int i = 0; i < 20000; ++i) angles.insert(angles.end(), kKnown.begin(), kKnown.end());
    std::sort(angles.begin(), angles.end());
    const AnglePercentiles found = sum.percentiles();
    for (std::size_t i = 0; i < found.low.size(); ++i) {
        const auto rank = std::size_t(AnglePercentiles::kPercents[i] / 100 * double(angles.size()));
        CHECK(found.low[i] == Approx(angles[rank]).margin(0.2));
        CHECK(found.high[i] == Approx(angles[angles.size() - 1 - rank]).margin(0.2));
    }
    std::int64_t total = 0;
    for (const AngleBin& bin : sum.bins()) {
        const auto counted = std::count_if(angles.begin(), angles.end(), [&](double angle) {
            // At the edges of a bin rounding decides.
            return angle >= bin.low - 1e-9 && angle <= bin.high + 1e-9;
        });
        CHECK(bin.count <= counted);
        total += bin.count;
    }
    CHECK(total == std::int64_t(angles.size()));
}

TEST_CASE("slices are chosen the same on every instruction set", "[simd]") {
    const auto grid = levelSet(noiseBall(3, Vec3d(0.0), 14.0, 3.0));
    const Stages stages(*grid);
    Interrupt interrupt(nullptr);
    const Destinations destinations =
        findDestinations(stages.field, stages.layout, stages.cuts.arrows, stages.labels, interrupt);
    const Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
    LocalVertices local(vertices);
    std::size_t chosen = 0;
    for (TileRef tile : stages.cuts.arrows.tiles) {
        local.load(tile);
        std::vector<LocalOctahedron> octahedra;
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            for (int axis = 0; axis < 3; ++axis) {
                const PaddedMask &in = local.interiorMask(lattice), &on = local.manifoldMask(lattice);
                const TileMask spines = (in.core() ^ in.shifted(axis == 0, axis == 1, axis == 2)) &
                                        ~(on.core() | on.shifted(axis == 0, axis == 1, axis == 2));
                spines.forEach([&](int n) {
                    octahedra.push_back(localOctahedron(lattice, axis, localIndex(lattice, n)));
                });
            }
        }
        std::vector<bcc::Slice> plain, other;
        chooseActiveSlices(local, octahedra, SliceRule::Policy, plain, Isa::Plain);
        for (std::size_t i = 0; i < octahedra.size(); ++i) {
            // Lanes decide where it is clear; the rule decides everywhere.
            const SliceQuality a = sliceQuality(local, octahedra[i], bcc::SliceA),
                               b = sliceQuality(local, octahedra[i], bcc::SliceB);
            REQUIRE(plain[i] == (better(b, a) ? bcc::SliceB : bcc::SliceA));
        }
        for (Isa isa : vectorSets()) {
            chooseActiveSlices(local, octahedra, SliceRule::Policy, other, isa);
            REQUIRE(other == plain);
        }
        chooseActiveSlices(local, octahedra, SliceRule::Worth, plain, Isa::Plain);
        for (std::size_t i = 0; i < octahedra.size(); ++i) {
            const double a = worth(sliceQuality(local, octahedra[i], bcc::SliceA)),
                         b = worth(sliceQuality(local, octahedra[i], bcc::SliceB));
            REQUIRE(plain[i] == (b > a + kTieAngle ? bcc::SliceB : bcc::SliceA));
        }
        for (Isa isa : vectorSets()) {
            chooseActiveSlices(local, octahedra, SliceRule::Worth, other, isa);
            REQUIRE(other == plain);
        }
        chosen += plain.size();
    }
    REQUIRE(chosen > 100);
}

TEST_CASE("suspects are the same on every instruction set", "[simd]") {
    const auto grid = levelSet(noiseBall(1, {0.1, 0.2, 0.3}, 12, 1.5));
    const Stages stages(*grid);
    const Destinations destinations;
    const Vertices vertices{stages.layout, stages.cuts.signs, stages.labels, destinations};
    int found = 0;
    LocalStates states;
    for (TileRef t = 0; t < stages.layout.surfaceCount(); ++t) {
        states.load(vertices, t);
        const auto plain = findSuspects(states, Isa::Plain);
        for (const Isa isa : vectorSets()) CHECK((findSuspects(states, isa) == plain));
        found += plain[bcc::A].count() + plain[bcc::B].count();
    }
    CHECK(found > 1000);
}

} // namespace vdbtet::test
