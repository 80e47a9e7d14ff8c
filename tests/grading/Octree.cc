/// Tets are judged in whole numbers: a determinant in half cells is 48 times the volume in cells.
#include "grading/Octree.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace vdbtet::test {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

const TileMask kAllInside = TileMask::filled(true);

Coord wrapped(const Coord& at, int period) {
    Coord result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = (at[axis] % period + period) % period;
    return result;
}

Coord scaled(const Coord& at, int factor) { return Coord(at.x() * factor, at.y() * factor, at.z() * factor); }

/// The tile of a cell or of a vertex in cells, and its bit in it.
Coord tileAt(const Coord& cell) { return Coord(cell.x() >> 3, cell.y() >> 3, cell.z() >> 3); }
int bitAt(const Coord& cell) { return TileMask::bit(cell.x() & 7, cell.y() & 7, cell.z() & 7); }
Coord cellAt(const Coord& tile, int n) {
    return scaled(tile, TileMask::kDim) + Coord(n >> 6, n >> 3 & 7, n & 7);
}

void fillCoarsest(Octree& octree) {
    for (OctantSet& set : octree.octants) {
        if (octree.coarsest == 1) set.level1 = ~std::uint64_t(0);
        if (octree.coarsest == 2) set.level2 = 0xff;
        if (octree.coarsest == 3) set.level3 = true;
    }
}

/// The tets of all pairs of cells at a face: one for each edge of the face.
void addLatticeTets(const Octree& octree, const Coord& cell, std::vector<OctreeTet>& tets) {
    for (int axis = 0; axis < 3; ++axis) {
        Coord along, u, v;
        along[axis] = u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1;
        if (!octree.hasCell(cell + along)) continue;
        const Coord centre = scaled(cell, 2) + Coord(1), face = centre + along;
        const Coord ring[4] = {face - u - v, face + u - v, face + u + v, face - u + v};
        for (int i = 0; i < 4; ++i)
            tets.push_back({TetKind::Lattice, 0, {centre, face + along, ring[i], ring[(i + 1) % 4]}});
    }
}

/// Six times the volume of a tet.
std::int64_t determinant(const std::array<Coord, 4>& points) {
    const Coord u = points[1] - points[0], v = points[2] - points[0], w = points[3] - points[0];
    const auto minor = [&](int i, int j) { return std::int64_t(v[i]) * w[j] - std::int64_t(v[j]) * w[i]; };
    return u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1);
}

bool isOfItsKind(const OctreeTet& tet) {
    constexpr int kDeterminants[kTetKinds] = {4, 2, 1, 4};
    const int kind = int(tet.kind);
    if (determinant(tet.points) != kDeterminants[kind] << 3 * tet.level) return false;
    Vec3d p[4];
    std::transform(tet.points.begin(), tet.points.end(), p, [](const Coord& at) { return at.asVec3d(); });
    std::array<double, 6> angles = dihedralAngles(p[0], p[1], p[2], p[3]);
    std::sort(angles.begin(), angles.end());
    return std::equal(angles.begin(), angles.end(), kAnglesOfKind[kind].begin(),
                      [](double angle, int expected) { return std::abs(angle - expected) < 1e-9; });
}

/// @return a number of a face, the same wherever in the periods it is; odd on one of its sides, and one less
/// on the other.
/// @details Its wrapped vertices would not do: in a small box several faces have the same.
std::uint64_t faceNumber(Coord a, Coord b, Coord c, int period) {
    bool odd = false;
    const auto order = [&](Coord& lower, Coord& upper) {
        if (!(upper < lower)) return;
        std::swap(lower, upper);
        odd = !odd;
    };
    order(a, b);
    order(b, c);
    order(a, b);
    const Coord lowest = wrapped(a, period);
    std::uint64_t number = 0;
    for (int axis = 0; axis < 3; ++axis) number = number << 8 | std::uint64_t(lowest[axis]);
    for (const Coord& edge : {b - a, c - a}) {
        // At most 16 half cells to either side.
        for (int axis = 0; axis < 3; ++axis) number = number << 6 | std::uint64_t(edge[axis] + 32);
    }
    return number << 1 | std::uint64_t(odd);
}

std::int64_t unmatchedFaces(const std::vector<OctreeTet>& tets, int period) {
    std::vector<std::uint64_t> faces;
    faces.reserve(4 * tets.size());
    for (const OctreeTet& tet : tets) {
        const auto& [a, b, c, d] = tet.points;
        for (const std::uint64_t face : {faceNumber(b, c, d, period), faceNumber(a, d, c, period),
                                         faceNumber(a, b, d, period), faceNumber(a, c, b, period)})
            faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end());
    std::int64_t unmatched = 0;
    for (std::size_t begin = 0, end; begin < faces.size(); begin = end) {
        for (end = begin; end < faces.size() && faces[end] >> 1 == faces[begin] >> 1;) ++end;
        unmatched += end - begin != 2 || faces[begin] == faces[begin + 1];
    }
    return unmatched;
}

std::int64_t wrongVertices(const Octree& octree, const std::vector<OctreeTet>& tets) {
    std::vector<TileMask> corners(octree.cells.size()), centres(octree.cells.size());
    for (const OctreeTet& tet : tets) {
        for (const Coord& point : tet.points) {
            const Coord cell(point.x() >> 1, point.y() >> 1, point.z() >> 1);
            (point.x() & 1 ? centres : corners)[octree.number(tileAt(cell))].set(bitAt(cell));
        }
    }
    std::int64_t wrong = 0;
    octree.forEachTile([&](const Coord& tile) {
        const std::size_t t = octree.number(tile);
        wrong += (corners[t] ^ octree.around(tile).vertices()).count();
        wrong += (centres[t] ^ octree.cells[t]).count();
    });
    return wrong;
}

} // namespace

std::size_t Octree::number(const Coord& tile) const {
    const Coord at = wrapped(tile, tiles);
    return std::size_t((at.x() * tiles + at.y()) * tiles + at.z());
}

bool Octree::hasCell(const Coord& cell) const { return cells[number(tileAt(cell))].test(bitAt(cell)); }

LocalOctants Octree::around(const Coord& tile) const {
    std::array<OctantPart, 27> parts;
    for (int slot = 0; slot < 27; ++slot) {
        const std::size_t t = number(tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1));
        parts[slot] = {&cells[t], octants[t], &kAllInside};
    }
    LocalOctants result;
    result.load(parts, tile, coarsest);
    return result;
}

Octree closedOctree(int tiles, int coarsest, const std::vector<TileMask>& cells) {
    Octree octree{tiles, coarsest, cells, std::vector<OctantSet>(cells.size())};
    octree.forEachTile([&](const Coord& tile) {
        std::array<const TileMask*, 27> units;
        for (int slot = 0; slot < 27; ++slot) {
            const Coord neighbour = tile.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
            units[slot] = &cells[octree.number(neighbour)];
        }
        octree.octants[octree.number(tile)] = closeOctants(units);
    });
    fillCoarsest(octree);
    return octree;
}

Octants balanced(const std::set<Coord>& cells, int reach, int period) {
    Octants octants{cells};
    for (std::size_t level = 0; level + 1 < octants.size(); ++level) {
        for (const Coord& octant : octants[level]) {
            for (int slot = 0; slot < 27; ++slot) {
                const Coord step(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1);
                if (std::abs(step.x()) + std::abs(step.y()) + std::abs(step.z()) > reach) continue;
                const Coord at = period > 0 ? wrapped(octant + step, period >> level) : octant + step;
                octants[level + 1].insert(Coord(at.x() >> 1, at.y() >> 1, at.z() >> 1));
            }
        }
    }
    return octants;
}

Octree balancedOctree(int tiles, int coarsest, const std::vector<TileMask>& cells, int reach) {
    Octree octree{tiles, coarsest, cells, std::vector<OctantSet>(cells.size())};
    std::set<Coord> all;
    octree.forEachTile([&](const Coord& tile) {
        cells[octree.number(tile)].forEach([&](int n) { all.insert(cellAt(tile, n)); });
    });
    const Octants octants = balanced(all, reach, octree.edge());
    for (const Coord& at : octants[1]) {
        const Coord tile(at.x() >> 2, at.y() >> 2, at.z() >> 2);
        octree.octants[octree.number(tile)].level1 |=
            std::uint64_t(1) << ((at.x() & 3) << 4 | (at.y() & 3) << 2 | (at.z() & 3));
    }
    for (const Coord& at : octants[2]) {
        const Coord tile(at.x() >> 1, at.y() >> 1, at.z() >> 1);
        octree.octants[octree.number(tile)].level2 |=
            std::uint8_t(1 << ((at.x() & 1) << 2 | (at.y() & 1) << 1 | (at.z() & 1)));
    }
    for (const Coord& at : octants[3]) octree.octants[octree.number(at)].level3 = true;
    fillCoarsest(octree);
    return octree;
}

std::vector<OctreeTet> tetsOf(const Octree& octree) {
    std::vector<OctreeTet> tets;
    octree.forEachTile([&](const Coord& tile) {
        const LocalOctants octants = octree.around(tile);
        const Coord origin = scaled(tile, 2 * TileMask::kDim);
        const auto pointOf = [&](int point) {
            return origin + Coord(2 * unitX(point), 2 * unitY(point), 2 * unitZ(point));
        };
        for (int level = 1; level <= octree.coarsest; ++level) {
            forEachTetOfLevel(octants, level, [&](TetKind kind, int a, int b, int c, int d) {
                tets.push_back({kind, level, {pointOf(a), pointOf(b), pointOf(c), pointOf(d)}});
            });
        }
        forEachTetOfFringe(octants, kAllInside, [&](TetKind kind, int n, int b, int c, int d) {
            const Coord centre = scaled(cellAt(tile, n), 2) + Coord(1);
            tets.push_back({kind, 0, {centre, pointOf(b), pointOf(c), pointOf(d)}});
        });
        octree.cells[octree.number(tile)].forEach(
            [&](int n) { addLatticeTets(octree, cellAt(tile, n), tets); });
    });
    return tets;
}

OctreeFaults faultsOf(const Octree& octree, const std::vector<OctreeTet>& tets) {
    OctreeFaults faults;
    faults.volume = -48 * std::int64_t(octree.edge()) * octree.edge() * octree.edge();
    for (const OctreeTet& tet : tets) {
        faults.misshapen += !isOfItsKind(tet);
        faults.volume += determinant(tet.points);
    }
    faults.unmatchedFaces = unmatchedFaces(tets, 2 * octree.edge());
    faults.wrongVertices = wrongVertices(octree, tets);
    return faults;
}

} // namespace vdbtet::test
