/// @file Measure.cc
/// Counts, boundary faces, angles and bounds of the mesh (paper, section 4.5).
#include "emit/Measure.h"

#include "emit/Angles.h"

#include <tbb/parallel_reduce.h>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

/// A vertex in doubled coordinates seen from a tile: L_A even, L_B odd.
struct Doubled {
    int c[3];

    explicit Doubled(int local) {
        const int lattice = local / 1000, n = local % 1000;
        c[0] = 2 * (n / 100 - 1) + lattice;
        c[1] = 2 * (n / 10 % 10 - 1) + lattice;
        c[2] = 2 * (n % 10 - 1) + lattice;
    }
    Doubled(const Doubled& a, const Doubled& b, const Doubled& minus) {
        for (int i = 0; i < 3; ++i) c[i] = a.c[i] + b.c[i] - minus.c[i];
    }
    int lattice() const { return c[0] & 1; }
    int x() const { return c[0] >> 1; }
    int y() const { return c[1] >> 1; }
    int z() const { return c[2] >> 1; }
};

bool interior(const TetWalk& walk, const Doubled& v) {
    return walk.stateAt(v.lattice(), v.x(), v.y(), v.z()) == State::Inside;
}

/// @return whether the tet beyond an outer face of an octahedron is in the mesh.
/// @param end       the end of the octahedron's spine in the face
/// @param otherEnd  its other end
/// @param o1,o2     the ring edge in the face
/// @details Beyond lies the octahedron of the spine from @a end to the mirror image of @a otherEnd. All of
/// the face is manifold, so the fourth vertex decides.
bool beyondOuterFace(const TetWalk& walk, const Doubled& end, const Doubled& otherEnd, const Doubled& o1,
                     const Doubled& o2) {
    const Doubled mirrored(o1, o2, otherEnd);
    int axis = 0;
    while (mirrored.c[axis] == end.c[axis]) ++axis;
    const Doubled& lower = mirrored.c[axis] < end.c[axis] ? mirrored : end;
    const bcc::Slice slice = walk.slice(axis, localIndex(lower.lattice(), lower.x(), lower.y(), lower.z()));
    if (slice == bcc::S) return interior(walk, mirrored);

    // A flipped octahedron: the fourth vertex is the far end of the ring's diagonal, which starts at o1 or at
    // o2.
    const bcc::Octahedron& vertices = bcc::kOctahedra[lower.lattice()][axis];
    const bcc::Vertex& diagonal = vertices[slice == bcc::SliceA ? 2 : 3];
    const bcc::Vertex& opposite = vertices[slice == bcc::SliceA ? 4 : 5];
    auto is = [&](const bcc::Vertex& v, const Doubled& d) {
        return lower.x() + v.x == d.x() && lower.y() + v.y == d.y() && lower.z() + v.z == d.z();
    };
    const Doubled& start = is(diagonal, o1) || is(opposite, o1) ? o1 : o2;
    return interior(walk, Doubled(end, mirrored, start));
}

/// @return whether the face of three manifold vertices of a tet in the mesh lies on the mesh's boundary.
bool faceIsBoundary(const TetWalk& walk, const LocalTet& tet) {
    const LocalVertices& local = walk.local();
    int apex = 0;
    while (local.manifold(tet.vertex(apex))) ++apex;
    const auto& numbers = bcc::kSliceTets[tet.slice][tet.number];
    const auto at = [&](int number) { return Doubled(tet.octahedron[number]); };

    if (tet.slice == bcc::S) {
        // The tet is an edge of each lattice; across its face lies the octahedron of the edge without the
        // apex's other end.
        int partner = -1, across[2], n = 0;
        for (int i = 0; i < 4; ++i) {
            if (i == apex) continue;
            if ((numbers[i] < 2) == (numbers[apex] < 2))
                partner = numbers[i];
            else
                across[n++] = numbers[i];
        }
        return !beyondOuterFace(walk, at(partner), at(numbers[apex]), at(across[0]), at(across[1]));
    }

    // A flipped tet: an end of the spine, the diagonal of the ring, and one more vertex of the ring.
    const int from = tet.slice == bcc::SliceA ? 2 : 3, to = from + 2;
    int end = -1, third = -1;
    for (int number : numbers) {
        if (number < 2)
            end = number;
        else if (number != from && number != to)
            third = number;
    }
    const int number = numbers[apex];
    if (number == end) return !interior(walk, at(1 - end));
    if (number == third) return !interior(walk, Doubled(at(from), at(to), at(third)));
    return !beyondOuterFace(walk, at(end), at(1 - end), at(number == from ? to : from), at(third));
}

struct TileMeasure {
    std::int64_t tets = 0, ambiguous = 0, triangles = 0;
};

/// What one range of tiles contributes; sums of integers and extremes, so the order does not matter.
struct RangeMeasure {
    AngleSum angles;
    openvdb::BBoxd bounds;
};

void expandByPoints(const Vertices& vertices, const Numbering& numbering, const Frame& frame,
                    const LocalVertices& local, TileRef tile, openvdb::BBoxd& bounds) {
    const openvdb::Coord& at = vertices.layout.surfaceTiles[tile];
    const Vec3d origin(8.0 * at.x(), 8.0 * at.y(), 8.0 * at.z());
    for (int lattice = 0; lattice < 2; ++lattice) {
        // The mesh is bounded by manifold vertices alone, and its points lie in their convex hull.
        (numbering.used[tile][lattice] & vertices.labels.manifold[tile][lattice]).forEach([&](int n) {
            bounds.expand(frame.world(origin + local.position(localIndex(lattice, n))));
        });
    }
}

} // namespace

Measure measureMesh(const Vertices& vertices, const Flips& flips, const Numbering& numbering,
                    const Frame& frame, Interrupt& interrupt) {
    const Layout& layout = vertices.layout;
    const std::int64_t tiles = layout.surfaceCount();
    std::vector<TileMeasure> measures(tiles);
    constexpr std::int64_t kGrain = 32;
    const RangeMeasure all = tbb::parallel_reduce(
        tbb::blocked_range<std::int64_t>(0, tiles, kGrain), RangeMeasure(),
        [&](const tbb::blocked_range<std::int64_t>& range, RangeMeasure part) {
            if (interrupt.poll()) return part;
            TetWalk walk(vertices, flips);
            for (std::int64_t t = range.begin(); t < range.end(); ++t) {
                walk.load(TileRef(t));
                const LocalVertices& local = walk.local();
                TileMeasure& measure = measures[t];
                measure.ambiguous = walk.forEachTet([&](const LocalTet& tet, int manifold) {
                    ++measure.tets;
                    if (manifold == 0 && tet.slice == bcc::S) {
                        part.angles.addLatticeTets(1);
                        return;
                    }
                    part.angles.add(local.position(tet.vertex(0)), local.position(tet.vertex(1)),
                                    local.position(tet.vertex(2)), local.position(tet.vertex(3)));
                    if (manifold == 3) measure.triangles += faceIsBoundary(walk, tet);
                });
                expandByPoints(vertices, numbering, frame, local, TileRef(t), part.bounds);
            }
            return part;
        },
        [](RangeMeasure a, const RangeMeasure& b) {
            a.angles += b.angles;
            a.bounds.expand(b.bounds);
            return a;
        });

    Measure measure;
    AngleSum angles = all.angles;
    measure.bounds = all.bounds;
    measure.first.reserve(layout.spans.size() + 1);
    measure.first.push_back(0);
    for (const Layout::Span& span : layout.spans) {
        std::int64_t tets = kInteriorTets * span.count;
        if (span.surface >= 0) {
            const TileMeasure& tile = measures[span.surface];
            tets = tile.tets;
            measure.ambiguous += tile.ambiguous;
            measure.boundaryTriangles += tile.triangles;
        } else {
            angles.addLatticeTets(tets);
        }
        measure.first.push_back(measure.first.back() + tets);
    }
    measure.angles = angles.stats();
    return measure;
}

} // namespace vdbtet
