// Files from public repositories: level sets as they are, densities at a sensible isovalue, the rest refused.
#include "shared/Expectation.h"
#include "support/Catch.h"
#include "support/SharedData.h"

#include <algorithm>

using namespace vdbtet;
using namespace vdbtet::test;

namespace {

std::vector<Expectation> expectations() {
    std::vector<Expectation> all;
    const auto expect = [&](const Expectation& e) { all.push_back(e); };

    const Expectation clouds("Autodesk__grids__c042818e.vdb");
    expect(Expectation(clouds).refused<UnsupportedGrid>());
    for (const char* name : {"density[0]", "density[1]", "density[2]"})
        expect(Expectation(clouds).grid(name).iso(1));
    expect(Expectation(clouds).grid("density[3]").refused<FileError>());
    expect(Expectation("Autodesk__pointgrid__71b89e9a.vdb").refused<UnsupportedGrid>());
    expect(Expectation("Autodesk__smoke__b85d0834.vdb").iso(0.5));
    expect(Expectation("Autodesk__torus01__ad5e6877.vdb").iso(50).components(1).euler(0));
    expect(Expectation("GafferHQ__points__7a24d8e6.vdb").refused<UnsupportedGrid>());
    expect(Expectation("GafferHQ__sphere__27e27f6f.vdb").components(1).euler(2));
    expect(Expectation("Housz__test__a41df7ed.vdb").refused<NoSurface>());
    expect(Expectation("NemoInfo__cube__014d1010.vdb").voxels(2).components(1).euler(2));

    const Expectation fire("PixarAnimationStudios__densityAndHeat__52d01502.vdb");
    expect(Expectation(fire).refused<UnsupportedGrid>());
    expect(Expectation(fire).grid("density"));
    expect(Expectation(fire).grid("heat").iso(0.2));
    const Expectation firstFrame("PixarAnimationStudios__smoke_000001__2640f9d5.vdb");
    expect(Expectation(firstFrame).refused<UnsupportedGrid>());
    expect(Expectation(firstFrame).grid("density").refused<NoSurface>());
    expect(Expectation(firstFrame).grid("obstacles").refused<UnsupportedGrid>());
    expect(Expectation("PixarAnimationStudios__smoke_000002__382fbaa4.vdb").iso(0.3));
    expect(Expectation("PixarAnimationStudios__smoke_000003__44e72930.vdb").iso(0.3));

    expect(Expectation("mjurczyk__sphere__79e8fd86.vdb").voxels(2).components(1).euler(2).volume(113.1, 1));
    expect(Expectation("pyvista__sphere_points__6ad45fdc.vdb").refused<UnsupportedGrid>());
    // One everywhere, the background too.
    expect(Expectation("sergeneren__box__6c958941.vdb").refused<UnboundedInside>());
    expect(Expectation("sergeneren__box__6c958941.vdb").iso(2).refused<NoSurface>());
    expect(Expectation("sergeneren__dragon__3e4afa0b.vdb"));
    expect(Expectation("sergeneren__dragon_with_xform__a8325246.vdb"));
    expect(Expectation("zenustech__sphere__02d4d75f.vdb").components(1).euler(2));
    expect(Expectation("zenustech__vel_VDB_bound_v02__f4a0bca5.vdb").refused<UnsupportedGrid>());
    return all;
}

} // namespace

TEST_CASE("files of other programs are meshed or refused", "[shared]") {
    const auto folder = sharedPath("data/real");
    if (!folder) return;
    for (const Expectation& e : expectations()) e.check(folder->string());
}

TEST_CASE("every file of another program is expected to do something", "[shared]") {
    const auto folder = sharedPath("data/real");
    if (!folder) return;
    const std::vector<Expectation> known = expectations();
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
        const std::string name = entry.path().filename().string();
        CAPTURE(name);
        CHECK(
            std::any_of(known.begin(), known.end(), [&](const Expectation& e) { return e.file() == name; }));
    }
}

TEST_CASE("large level sets of other programs are meshed at their own voxel", "[shared][slow]") {
    const auto folder = sharedPath("data/real");
    if (!folder) return;
    Expectation("mjurczyk__sphere__79e8fd86.vdb")
        .components(1)
        .euler(2)
        .volume(113.1, 0.1)
        .check(folder->string());
    Expectation("NemoInfo__cube__014d1010.vdb").components(1).euler(2).check(folder->string());
}
