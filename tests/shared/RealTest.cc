// Files from public repositories: level sets as they are, densities at a sensible isovalue, the rest refused.
#include "shared/Expectation.h"
#include "support/Catch.h"
#include "support/SharedData.h"

#include <set>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

using Expectations = std::vector<Expectation>;

const Expectation kClouds("Autodesk__grids__c042818e.vdb");
const Expectation kFire("PixarAnimationStudios__densityAndHeat__52d01502.vdb");
const Expectation kFirstFrame("PixarAnimationStudios__smoke_000001__2640f9d5.vdb");
const Expectation kOnes("sergeneren__box__6c958941.vdb");

Expectations levelSets() {
    Expectations all;
    all.push_back(Expectation("NemoInfo__cube__014d1010.vdb").voxels(4).components(1).euler(2));
    all.push_back(
        Expectation("mjurczyk__sphere__79e8fd86.vdb").voxels(2).components(1).euler(2).volume(113.1, 1));
    all.push_back(Expectation("zenustech__sphere__02d4d75f.vdb").components(1).euler(2));
    return all;
}

Expectations densities() {
    Expectations all;
    for (const char* name : {"density[0]", "density[1]", "density[2]"})
        all.push_back(Expectation(kClouds).grid(name).iso(1));
    all.push_back(Expectation("Autodesk__smoke__b85d0834.vdb").iso(0.5));
    all.push_back(Expectation("Autodesk__torus01__ad5e6877.vdb").iso(50).components(1).euler(0));
    all.push_back(Expectation("GafferHQ__sphere__27e27f6f.vdb").components(1).euler(2));
    all.push_back(Expectation(kFire).grid("density"));
    all.push_back(Expectation(kFire).grid("heat").iso(0.2));
    all.push_back(Expectation("PixarAnimationStudios__smoke_000002__382fbaa4.vdb").iso(0.3));
    all.push_back(Expectation("PixarAnimationStudios__smoke_000003__44e72930.vdb").iso(0.3));
    all.push_back(Expectation("sergeneren__dragon__3e4afa0b.vdb"));
    all.push_back(Expectation("sergeneren__dragon_with_xform__a8325246.vdb"));
    return all;
}

Expectations refusals() {
    Expectations all;
    all.push_back(Expectation(kClouds).refused<UnsupportedGrid>()); // three grids to choose from
    all.push_back(Expectation(kClouds).grid("density[3]").refused<FileError>());
    all.push_back(Expectation(kFire).refused<UnsupportedGrid>());
    all.push_back(Expectation(kFirstFrame).refused<UnsupportedGrid>());
    all.push_back(Expectation(kFirstFrame).grid("density").refused<NoSurface>());
    all.push_back(Expectation(kFirstFrame).grid("obstacles").refused<UnsupportedGrid>());
    all.push_back(Expectation(kOnes).refused<UnboundedInside>()); // its background is one, too
    all.push_back(Expectation(kOnes).iso(2).refused<NoSurface>());
    all.push_back(Expectation("Autodesk__pointgrid__71b89e9a.vdb").refused<UnsupportedGrid>());
    all.push_back(Expectation("GafferHQ__points__7a24d8e6.vdb").refused<UnsupportedGrid>());
    all.push_back(Expectation("Housz__test__a41df7ed.vdb").refused<NoSurface>());
    all.push_back(Expectation("pyvista__sphere_points__6ad45fdc.vdb").refused<UnsupportedGrid>());
    all.push_back(Expectation("zenustech__vel_VDB_bound_v02__f4a0bca5.vdb").refused<UnsupportedGrid>());
    return all;
}

void check(const Expectations& expectations) {
    const auto folder = sharedPath("data/real");
    if (!folder) return;
    for (const Expectation& e : expectations) e.check(folder->string());
}

} // namespace

TEST_CASE("level sets of other programs are meshed", "[shared]") { check(levelSets()); }

TEST_CASE("densities of other programs are meshed", "[shared]") { check(densities()); }

TEST_CASE("files of other programs without a solid are refused", "[shared]") { check(refusals()); }

TEST_CASE("every file of another program is expected to do something", "[shared]") {
    const auto folder = sharedPath("data/real");
    if (!folder) return;
    std::set<std::string> known;
    for (const Expectations& list : {levelSets(), densities(), refusals()})
        for (const Expectation& e : list) known.insert(e.file());
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
        const std::string name = entry.path().filename().string();
        CAPTURE(name);
        CHECK(known.count(name) == 1);
    }
}

TEST_CASE("large level sets of other programs are meshed finely", "[shared][slow]") {
    check({Expectation("mjurczyk__sphere__79e8fd86.vdb").components(1).euler(2).volume(113.1, 0.1),
           Expectation("NemoInfo__cube__014d1010.vdb").voxels(2).components(1).euler(2)});
}
