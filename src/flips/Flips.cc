/// @file Flips.cc
/// Algorithms 4 and 5 (paper, sections 4.4 and 6.2), an octahedron at a time.
#include "flips/Flips.h"

#include "quality/Dihedral.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

constexpr double kMinAngle = 11.47;  // degrees; the policy of Algorithm 4
constexpr double kTieAngle = 1e-5;   // degrees; more than distances in float can turn an angle
constexpr double kExtremeMove = 0.3; // of a short edge; Algorithm 5

/// How good the tets of a slice are that will be in the mesh.
struct SliceQuality {
    bool inverted = false;
    double min = 180.0, max = 0.0;
};

SliceQuality sliceQuality(const LocalVertices& vertices, const LocalOctahedron& octahedron,
                          bcc::Slice slice) {
    SliceQuality quality;
    double minCos = 1.0, maxCos = -1.0;
    for (const auto& tet : bcc::kSliceTets[slice]) {
        int manifold = 0;
        bool outside = false;
        const Vec3d* p[4];
        for (int i = 0; i < 4; ++i) {
            const int local = octahedron[tet[i]];
            p[i] = &vertices.position(local);
            const State state = vertices.state(local);
            manifold += state == State::Manifold;
            outside = outside || state == State::Outside;
        }
        if (outside || manifold == 4) continue;
        // An inverted tet can show fine angles by the unsigned formula.
        if (signedVolume6(*p[0], *p[1], *p[2], *p[3]) <= 0.0) quality.inverted = true;
        for (double cosine : dihedralCosines(*p[0], *p[1], *p[2], *p[3])) {
            minCos = std::min(minCos, cosine);
            maxCos = std::max(maxCos, cosine);
        }
    }
    if (maxCos >= minCos) {
        quality.min = angleOf(maxCos);
        quality.max = angleOf(minCos);
    }
    return quality;
}

/// The policy of Algorithm 4, made safe against inverted tets and rounding.
bool better(const SliceQuality& a, const SliceQuality& b) {
    if (a.inverted != b.inverted) return b.inverted;
    const bool sameMin = std::abs(a.min - b.min) <= kTieAngle, sameMax = std::abs(a.max - b.max) <= kTieAngle;
    if (a.min > kMinAngle && b.min > kMinAngle) return sameMax ? !sameMin && a.min > b.min : a.max < b.max;
    return sameMin ? !sameMax && a.max < b.max : a.min > b.min;
}

/// @return the fraction of a short edge that a manifold vertex moves if that is along the short edge vector
/// @a along, else 0.
double moveAlong(const LocalVertices& vertices, int local, const Vec3d& along) {
    const Vec3d move = vertices.move(local);
    double least = 1.0;
    for (int axis = 0; axis < 3; ++axis) least = std::min(least, move[axis] * along[axis]);
    // The components of the edge are +-1/2, those of a move by alpha +-alpha/2.
    return std::max(0.0, 4.0 * least);
}

/// @return the fraction of a short edge that a manifold vertex moves, whichever way.
double moveLength(const LocalVertices& vertices, int local) {
    return vertices.move(local).length() * 2.0 / std::sqrt(3.0);
}

} // namespace

bcc::Slice chooseActiveSlice(const LocalVertices& vertices, const LocalOctahedron& octahedron) {
    return better(sliceQuality(vertices, octahedron, bcc::SliceB),
                  sliceQuality(vertices, octahedron, bcc::SliceA))
               ? bcc::SliceB
               : bcc::SliceA;
}

ExtraFlip chooseExtraSlice(const LocalVertices& vertices, const LocalOctahedron& octahedron) {
    ExtraFlip flip;
    // v2 is the manifold end. Where it is the lower one the figure is seen in a mirror, which swaps its two
    // cases and nothing else.
    const bool reversed = vertices.manifold(octahedron[0]);
    const int v1 = octahedron[reversed ? 1 : 0], v2 = octahedron[reversed ? 0 : 1];
    if (vertices.state(v1) != State::Inside || !vertices.manifold(v2)) return flip;

    const Vec3d at2 = LocalVertices::home(v2);
    for (int k = 0; k < 4; ++k) {
        const auto ring = [&](int i) { return octahedron[2 + (k + i) % 4]; };
        const int v3 = ring(0), v4 = ring(1), v5 = ring(2), v6 = ring(3);
        if (!vertices.manifold(v3) || !vertices.manifold(v4)) continue;
        if (moveAlong(vertices, v3, at2 - LocalVertices::home(v4)) < kExtremeMove) continue;
        if (moveAlong(vertices, v4, at2 - LocalVertices::home(v3)) < kExtremeMove) continue;
        const bool from5 = moveAlong(vertices, v2, at2 - LocalVertices::home(v5)) >= kExtremeMove;
        const bool from6 = moveAlong(vertices, v2, at2 - LocalVertices::home(v6)) >= kExtremeMove;
        if (!from5 && !from6) continue;

        flip.matches = true;
        const bool manifold5 = vertices.manifold(v5), manifold6 = vertices.manifold(v6);
        flip.conflict = manifold5 || manifold6;
        if (!flip.conflict) {
            // The new edge ends at v5 or v6, of which v5 is the (k+2)-th of the ring.
            flip.slice = (k % 2 == 0) == from5 ? bcc::SliceA : bcc::SliceB;
        } else if (!(manifold5 && manifold6) && moveLength(vertices, manifold5 ? v5 : v6) < kExtremeMove) {
            // So short a move rules out that the edge (v5,v6) wants a flip as well.
            SliceQuality best = sliceQuality(vertices, octahedron, bcc::S);
            for (bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
                const SliceQuality quality = sliceQuality(vertices, octahedron, slice);
                if (better(quality, best)) {
                    best = quality;
                    flip.slice = slice;
                }
            }
        }
        return flip; // v4 cannot move two ways, so no other pair matches
    }
    return flip;
}

namespace {

/// The spines of a tile that a flip may concern.
struct Candidates {
    TileMask active[2][3];
    TileMask extra[2][3];
    bool any = false;
};

Candidates findCandidates(const LocalStates& states, bool withExtra) {
    Candidates candidates;
    for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
        const PaddedMask &interior = states.interiorMask(lattice), &manifold = states.manifoldMask(lattice);
        const TileMask in1 = interior.core(), on1 = manifold.core();
        for (int axis = 0; axis < 3; ++axis) {
            const TileMask in2 = interior.shifted(axis == 0, axis == 1, axis == 2),
                           on2 = manifold.shifted(axis == 0, axis == 1, axis == 2);
            TileMask& active = candidates.active[lattice][axis];
            active = (in1 ^ in2) & ~(on1 | on2);
            candidates.any = candidates.any || active.any();
            if (!withExtra) continue;
            TileMask& extra = candidates.extra[lattice][axis];
            extra = (in1 & on2) | (on1 & in2);
            if (!extra.any()) continue;
            // Two neighbours on the ring are manifold as well.
            const auto ring = [&](int i) {
                const bcc::Vertex& v = bcc::kOctahedra[lattice][axis][2 + i];
                return states.manifoldMask(v.lattice).shifted(v.x, v.y, v.z);
            };
            const TileMask on3 = ring(0), on4 = ring(1), on5 = ring(2), on6 = ring(3);
            extra &= (on3 | on5) & (on4 | on6);
            candidates.any = candidates.any || extra.any();
        }
    }
    return candidates;
}

/// The flips of one tile.
struct TileFlips {
    std::vector<std::uint16_t> codes;
    std::int32_t active = 0, extra = 0, lastResort = 0, conflicts = 0;
};

TileFlips flipTile(const Candidates& candidates, const LocalVertices& local) {
    TileFlips flips;
    for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto octahedron = [&](int n) {
                return localOctahedron(lattice, axis, localIndex(lattice, n));
            };
            const auto add = [&](bcc::Slice slice, int n) {
                flips.codes.push_back(Flips::encode({lattice, axis, slice, n}));
            };
            candidates.active[lattice][axis].forEach([&](int n) {
                add(chooseActiveSlice(local, octahedron(n)), n);
                ++flips.active;
            });
            candidates.extra[lattice][axis].forEach([&](int n) {
                const ExtraFlip flip = chooseExtraSlice(local, octahedron(n));
                flips.conflicts += flip.conflict;
                if (flip.slice == bcc::S) return;
                add(flip.slice, n);
                ++(flip.conflict ? flips.lastResort : flips.extra);
            });
        }
    }
    std::sort(flips.codes.begin(), flips.codes.end());
    return flips;
}

} // namespace

Flips chooseFlips(const Vertices& vertices, int version, Interrupt& interrupt) {
    const std::int64_t tiles = vertices.layout.surfaceCount();
    std::vector<TileFlips> parts(tiles);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        LocalStates states;
        LocalVertices local;
        for (std::int64_t t = begin; t < end; ++t) {
            states.load(vertices, TileRef(t));
            const Candidates candidates = findCandidates(states, version >= 2);
            if (!candidates.any) continue;
            local.load(vertices, TileRef(t));
            parts[t] = flipTile(candidates, local);
        }
    });

    Flips flips;
    flips.first.reserve(tiles + 1);
    flips.first.push_back(0);
    for (const TileFlips& part : parts) {
        flips.codes.insert(flips.codes.end(), part.codes.begin(), part.codes.end());
        flips.first.push_back(std::int64_t(flips.codes.size()));
        flips.active += part.active;
        flips.extra += part.extra;
        flips.lastResort += part.lastResort;
        flips.conflicts += part.conflicts;
    }
    return flips;
}

} // namespace vdbtet
