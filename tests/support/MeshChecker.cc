/// @file MeshChecker.cc
/// Compares figures with what they must be.
#include "support/MeshChecker.h"

#include "support/Catch.h"

#include <cmath>

namespace vdbtet::test {

using openvdb::Vec3d;

namespace {

/// @param doubled  how many points are where another one is
MeshFigures requireValid(const TetMesh& mesh, const AngleBound& bound, std::int64_t doubled) {
    const MeshFigures f = examine(mesh);
    CAPTURE(f.points, f.tets, f.minAngle, f.maxAngle, f.volume);
    REQUIRE(f.badIndices == 0);
    REQUIRE(f.nonFinitePoints == 0);
    REQUIRE(f.tets > 0);
    CHECK(f.inverted == 0);
    CHECK(f.overusedFaces == 0);
    CHECK(f.misorientedFaces == 0);
    CHECK(f.unusedPoints == 0);
    CHECK(f.duplicatePoints == doubled);
    CHECK(f.minAngle > bound.lo);
    CHECK(f.maxAngle < bound.hi);
    return f;
}

/// The sharpest bound that the counts of a report warrant.
AngleBound earnedBound(const Report& report) {
    if (report.tiger == 3 && report.flagged == 0) return report.boundary.filled > 0 ? kNoConflict : kGuarded;
    if (report.tiger == 2 && report.conflicts == 0) return kNoConflict;
    if (report.tiger == 2 && report.conflicts == report.lastResortFlips) return kLastResort;
    return kAlways;
}

} // namespace

MeshFigures requireClean(const TetMesh& mesh, const AngleBound& bound) {
    return requireValid(mesh, bound, 0);
}

MeshFigures requireClean(const TetMesh& mesh, const Report& report) {
    REQUIRE_FALSE(report.cancelled);
    const AngleBound bound = earnedBound(report);
    CHECK(report.angleMin >= bound.lo);
    CHECK(report.angleMax <= bound.hi);
    const MeshFigures f =
        requireValid(mesh, AngleBound{report.angleMin, report.angleMax}, report.boundary.split);
    CHECK(f.nonmanifoldPoints == report.boundary.left);
    if (report.boundary.left == 0) requireManifold(f);
    CHECK_FALSE(report.stages.empty());
    CHECK(report.points == f.points);
    CHECK(report.tets == f.tets);
    CHECK(report.boundaryTriangles == f.triangles);
    CHECK(std::abs(report.angles.min - f.minAngle) <= f.precision);
    CHECK(std::abs(report.angles.max - f.maxAngle) <= f.precision);
    std::int64_t below = 0;
    for (int i = 0; i < 18; ++i) {
        CAPTURE(i);
        CHECK(below >= f.surelyBelow[i]);
        CHECK(below <= f.maybeBelow[i]);
        below += report.angles.histogram[i];
    }
    CHECK(below == 6 * f.tets);
    openvdb::BBoxd bounds;
    for (const Vec3d& p : mesh.points) bounds.expand(p);
    CHECK(report.bounds.min().eq(bounds.min(), 0.0));
    CHECK(report.bounds.max().eq(bounds.max(), 0.0));
    return f;
}

void requireManifold(const MeshFigures& figures) {
    CHECK(figures.nonmanifoldEdges == 0);
    CHECK(figures.nonmanifoldPoints == 0);
}

} // namespace vdbtet::test
