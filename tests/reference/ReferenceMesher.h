/// @file ReferenceMesher.h
/// A slow, dense, serial TIGER written straight from the paper's Algorithms 1 to 5, to judge the fast one by.
#pragma once

#include "reference/DenseLattice.h"
#include "reference/ReferenceLabels.h"

namespace vdbtet::test {

enum class Labelling {
    Search, ///< Algorithms 2 and 3
    Kernel  ///< the definition; it also has an answer for ties and cycles
};

struct ReferenceMesh {
    std::vector<Vec3d> points; ///< lattice coordinates
    std::vector<std::array<std::int64_t, 4>> tets;

    std::int64_t ambiguous = 0;
    std::int64_t conflicts = 0;
    std::int64_t activeFlips = 0;
    std::int64_t extraFlips = 0;
    std::int64_t lastResortFlips = 0;
    std::int64_t qualityFlips = 0;
    std::int64_t flagged = 0;
    std::int64_t guardRounds = 0;
    std::int64_t cutEdges = 0;

    /// Where no rule says which of several meshes is right.
    std::int64_t manyRoots = 0;
    std::int64_t nearHalfTies = 0;
    /// Where the method leaves a choice open, and this project's rules decide.
    std::int64_t halfTies = 0;
    std::int64_t undecided = 0;
    std::int64_t destinationTies = 0;
    std::int64_t sliceTies = 0;

    /// Manifold vertices whose destination the search left stale; corrected.
    std::int64_t staleDestinations = 0;
};

/// @param phi    >= 0 inside, in lattice coordinates
/// @param box    the L_A points, with at least two layers of them outside all round
/// @param tiger  the version, 1 or 2
ReferenceMesh referenceMesh(const Phi& phi, const openvdb::CoordBBox& box, int tiger = 2,
                            Labelling labelling = Labelling::Search);

/// Version 3, with the kernel for its labels and all made anew in each round of the guard.
/// @param tau  of the threshold
ReferenceMesh thirdReferenceMesh(const Phi& phi, const openvdb::CoordBBox& box, double tau);

} // namespace vdbtet::test
