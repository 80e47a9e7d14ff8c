// Meshes a file and compares.
#include "shared/Expectation.h"

#include "support/Catch.h"
#include "support/MeshChecker.h"
#include "support/MeshMatch.h"
#include "support/Meshing.h"

#include <vdbtet/GridFile.h>

namespace vdbtet::test {

void Expectation::check(const std::string& folder) const {
    CAPTURE(mFile, mName, mOptions.isovalue.value_or(-999), mOptions.voxels);
    const auto work = [&] { meshOf(*readGrid(folder + "/" + mFile, mName), mOptions); };
    if (mRefusal) {
        CHECK(mRefusal(work));
    } else {
        checkMesh(folder);
    }
}

void Expectation::checkMesh(const std::string& folder) const {
    const Meshed result = meshOf(*readGrid(folder + "/" + mFile, mName), mOptions);
    const MeshFigures f = requireClean(result.mesh, result.report);
    if (mComponents) CHECK(f.components == *mComponents);
    if (mEuler) {
        CHECK(f.euler == *mEuler);
        requireManifold(f);
    }
    if (mVolume) CHECK(f.volume == Approx(*mVolume).epsilon(mPercent / 100));
    checkGraded(folder, f);
    if (mSameAs.empty()) return;
    const Meshed other = meshOf(*readGrid(folder + "/" + mSameAs), mOptions);
    if (mTolerance == 0) {
        requireIdentical(result.mesh, other.mesh);
    } else {
        requireSame(result.mesh, other.mesh, mTolerance * result.report.spacing);
    }
}

void Expectation::checkGraded(const std::string& folder, const MeshFigures& uniform) const {
    Options options = mOptions;
    options.grade = true;
    const Meshed result = meshOf(*readGrid(folder + "/" + mFile, mName), options);
    const MeshFigures f = requireClean(result.mesh, result.report);
    CHECK(f.triangles == uniform.triangles);
    CHECK(f.components == uniform.components);
    CHECK(f.euler == uniform.euler);
    CHECK(f.volume == Approx(uniform.volume).epsilon(1e-9));
}

} // namespace vdbtet::test
