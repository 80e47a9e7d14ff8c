/// @file MeshFault.cc
/// The same conditions as in support/MeshChecker.cc.
#include "fuzz/MeshFault.h"

#include "support/MeshFigures.h"

#include <cmath>

namespace vdbtet::test {

std::string meshFault(const TetMesh& mesh, const Report& report) {
    const MeshFigures f = examine(mesh);
    if (f.badIndices || f.nonFinitePoints) return "indices out of range, or points that are not finite";
    if (f.tets == 0) return "no tets";
    if (f.inverted) return "tets without volume";
    if (f.overusedFaces || f.misorientedFaces) return "faces of three tets, or seen alike from both sides";
    if (f.unusedPoints) return "points that no tet has";
    if (f.duplicatePoints != report.boundary.split) return "points in one place that no one has doubled";
    if (f.nonmanifoldPoints != report.boundary.left) return "a wrong count of bad vertices";
    if (report.boundary.left == 0 && f.nonmanifoldEdges) return "a boundary that is not a surface";
    if (!(f.minAngle > report.angleMin && f.maxAngle < report.angleMax)) return "angles out of the bound";
    if (!(report.angleMin >= 8.54 && report.angleMax <= 164.18)) return "a bound that nobody has proven";
    if (std::abs(report.angles.min - f.minAngle) > f.precision ||
        std::abs(report.angles.max - f.maxAngle) > f.precision)
        return "a report of other angles";
    if (report.points != f.points || report.tets != f.tets || report.boundaryTriangles != f.triangles)
        return "a report of other counts";
    return {};
}

} // namespace vdbtet::test
