/// The parts along the curve.
#include "support/Catch.h"

#include "mpi/Partition.h"

#include <algorithm>
#include <vector>

using namespace vdbtet::mpi;
using openvdb::Coord;

namespace {

/// A sphere's shell of tiles; some take more work.
std::vector<CurvePartition::Work> shell(int radius) {
    std::vector<CurvePartition::Work> work;
    for (int x = -radius; x <= radius; ++x) {
        for (int y = -radius; y <= radius; ++y) {
            for (int z = -radius; z <= radius; ++z) {
                const int r = x * x + y * y + z * z;
                if (r <= radius * radius && r > (radius - 1) * (radius - 1))
                    work.emplace_back(Coord(x, y, z), 1 + (x & 3));
            }
        }
    }
    return work;
}

} // namespace

TEST_CASE("Parts along the curve have equal shares of the work") {
    const auto work = shell(12);
    for (const int parts : {1, 2, 3, 4, 7}) {
        const CurvePartition partition(work, parts);
        std::vector<double> share(std::size_t(parts), 0.0);
        double total = 0.0;
        for (const auto& [place, amount] : work) {
            const int part = partition(place);
            REQUIRE(part >= 0);
            REQUIRE(part < parts);
            share[std::size_t(part)] += double(amount);
            total += double(amount);
        }
        for (const double one : share) CHECK(std::abs(one - total / parts) <= 8.0);
    }
}

TEST_CASE("Parts along the curve are compact") {
    const auto work = shell(12);
    const CurvePartition partition(work, 8);
    // Seams between eight slabs would be seven circles, of some 75 tiles on both sides.
    int seam = 0;
    for (const auto& [place, amount] : work) {
        bool beside = false;
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                Coord next = place;
                next[axis] += step;
                const bool there = std::any_of(work.begin(), work.end(),
                                               [&, at = next](const auto& one) { return one.first == at; });
                beside = beside || (there && partition(next) != partition(place));
            }
        }
        seam += beside;
    }
    CHECK(seam < int(work.size()) / 3);
}

TEST_CASE("A partition knows the part of places without work, and parts may be empty") {
    const CurvePartition partition({{Coord(5, 5, 5), 1}}, 3);
    for (const Coord& place : {Coord(5, 5, 5), Coord(-1000000, 7, 2000000000), Coord(0)}) {
        CHECK(partition(place) >= 0);
        CHECK(partition(place) < 3);
    }
    CHECK(CurvePartition({}, 2)(Coord(1)) < 2);
}

TEST_CASE("A partition reaches as far as coordinates do") {
    const CurvePartition partition({{Coord(-2000000000, 0, 0), 1}, {Coord(2000000000, 0, 0), 1}}, 2);
    CHECK(partition(Coord(-2000000000, 0, 0)) == 0);
    CHECK(partition(Coord(2000000000, 0, 0)) == 1);
}
