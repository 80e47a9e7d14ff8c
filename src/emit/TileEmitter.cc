/// @file TileEmitter.cc
/// Ids by rank, whole octahedra at a time.
#include "emit/TileEmitter.h"

#include "simd/Stream.h"

#include <algorithm>

namespace vdbtet {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

struct Cached {
    static void store(Tet& tet, std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        tet = {a, b, c, d};
    }
};
struct Streaming {
    static void store(Tet& tet, std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
        streamPair(tet.data(), a, b);
        streamPair(tet.data() + 2, c, d);
    }
};

/// Writes the tets of a tile, whose @a ids are by local number.
template <typename Stores>
class TetWriter {
public:
    TetWriter(const std::int64_t* ids, Tet* tets) : mIds(ids), mNext(tets) {}

    Tet* next() const { return mNext; }

    void write(const LocalTet& tet) {
        Stores::store(*mNext++, mIds[tet.vertex(0)], mIds[tet.vertex(1)], mIds[tet.vertex(2)],
                      mIds[tet.vertex(3)]);
    }

    /// The tets of all L_A spines along an axis, all of whose vertices are inside.
    template <int kAxis>
    void writeAll() {
        for (int x = 0; x < TileMask::kDim; ++x) {
            for (int y = 0; y < TileMask::kDim; ++y) {
                for (int z = 0; z < TileMask::kDim; ++z) writeOctahedron<kAxis>(localIndex(bcc::A, x, y, z));
            }
        }
    }

    /// The tets of the L_A spines along an axis that a surface tile has in the mesh.
    template <int kAxis>
    void writeFound(const TileTets& found) {
        const TileMask& flipped = found.flippedSpines(kAxis);
        TileMask whole = TileMask::filled(true);
        for (int number = 0; number < 4; ++number) whole &= found.latticeTets(kAxis, number);
        found.someTets(kAxis).forEach([&](int n) {
            const int lower = localIndex(bcc::A, n);
            if (whole.test(n)) {
                writeOctahedron<kAxis>(lower);
            } else if (flipped.test(n)) {
                found.forEachTetOf(kAxis, n, [&](const LocalTet& tet) { write(tet); });
            } else {
                const LocalOctahedron octahedron = localOctahedron(bcc::A, kAxis, lower);
                for (int number = 0; number < 4; ++number) {
                    if (found.latticeTets(kAxis, number).test(n)) write({octahedron, bcc::A, bcc::S, number});
                }
            }
        });
    }

private:
    /// The four tets of slice S.
    template <int kAxis>
    void writeOctahedron(int lower) {
        constexpr LocalOctahedron o = localOctahedron(bcc::A, kAxis, 0);
        const std::int64_t* ids = mIds + lower;
        const std::int64_t v[6] = {ids[o[0]], ids[o[1]], ids[o[2]], ids[o[3]], ids[o[4]], ids[o[5]]};
        for (const auto& tet : bcc::kSliceTets[bcc::S])
            Stores::store(*mNext++, v[tet[0]], v[tet[1]], v[tet[2]], v[tet[3]]);
    }

    const std::int64_t* mIds;
    Tet* mNext;
};

template <typename Stores>
Tet* writeSurfaceTile(const TileTets& found, const std::int64_t* ids, Tet* tets) {
    TetWriter<Stores> writer(ids, tets);
    writer.template writeFound<0>(found);
    writer.template writeFound<1>(found);
    writer.template writeFound<2>(found);
    found.forEachTetOfB([&](const LocalTet& tet) { writer.write(tet); });
    return writer.next();
}

template <typename Stores>
Tet* writeInteriorTile(const std::int64_t* ids, Tet* tets) {
    TetWriter<Stores> writer(ids, tets);
    writer.template writeAll<0>();
    writer.template writeAll<1>();
    writer.template writeAll<2>();
    return writer.next();
}

/// Each local number itself: what the writers of tets take for ids when local numbers are wanted.
const std::array<std::int64_t, kLocalVertices> kLocalNumbers = [] {
    std::array<std::int64_t, kLocalVertices> numbers{};
    for (int local = 0; local < kLocalVertices; ++local) numbers[local] = local;
    return numbers;
}();

/// The lowest vertex of a tile whose units are @a unit cells.
Vec3d originOf(const Coord& tile, double unit) { return 8.0 * unit * tile.asVec3d(); }

/// The place of a unitPoint() in a tile, in units.
Vec3d placeOf(int point) { return Vec3d(unitX(point), unitY(point), unitZ(point)); }

} // namespace

Output TileEmitter::emit(int tier, std::int64_t span, std::int64_t offset, Output out) {
    const Span& s = mGrading.tiers[tier].spans[span];
    const Coord tile = s.first.offsetBy(0, 0, int(offset));
    const SpansAround around = mGrading.tiers[tier].spans.around(tile);
    mIds.load(tier, tile, around);
    if (mGrading.top == 0 && s.tile < 0) {
        emitRunTile(tile, out);
        if (out.shapes) addRunShapes(tile, *out.shapes);
        return out;
    }
    const TileRef surface = mGrading.surfaceOf(tier, s.tile);
    const bool hasCells = load(tier, tile, surface, around);
    if (surface >= 0) {
        out.boundary ? findBoundary(surface) : mTets.change(mVertices.changesOf(surface));
        mMeasurer.measure(surface, mTets);
        emitSurfacePoints(tile, s.tile, surface, out);
    } else {
        emitPoints(tier, tile, bcc::A,
                   s.tile < 0 ? mNumbering.usedInRun[bcc::A] : mNumbering.usedA[tier][s.tile], false, out);
    }
    if (hasCells) {
        emitCells(surface, out);
        if (out.shapes) addCellShapes(tile, surface, *out.shapes);
    }
    if (surface >= 0 && out.boundary) emitBoundary(s.tile, surface, *out.boundary);
    if (mGrading.top > 0) {
        emitOctants(out);
        if (out.shapes) addOctantShapes(tier, tile, *out.shapes);
    }
    return out;
}

void TileEmitter::measure(int tier, std::int64_t span) {
    const Span& s = mGrading.tiers[tier].spans[span];
    const TileRef surface = mGrading.surfaceOf(tier, s.tile);
    if (surface < 0) return;
    const bool graded = mGrading.top > 0; // or else nobody asks what is around
    load(tier, s.first, surface, graded ? mGrading.tiers[tier].spans.around(s.first) : SpansAround{});
    mTets.change(mVertices.changesOf(surface));
    mMeasurer.measure(surface, mTets);
}

bool TileEmitter::load(int tier, const Coord& tile, TileRef surface, const SpansAround& around) {
    const bool graded = mGrading.top > 0;
    if (graded) {
        mGrading.load(mVertices.layout, mVertices.signs, tier, tile, around, mOctants);
        if (surface < 0 && (tier > 0 || !mOctants.exists(0).any())) return false;
    }
    mStates.load(mVertices, surface);
    if (graded) mStates.keepCells(mOctants.exists(0));
    mTets.load(surface, mStates);
    return true;
}

void TileEmitter::emitRunTile(const Coord& tile, Output& out) {
    for (int lattice = 0; lattice < 2; ++lattice)
        emitPoints(0, tile, lattice, mNumbering.usedInRun[lattice], out.streaming, out);
    mIds.findAll();
    const std::int64_t* ids = mIds.local();
    out.tets = out.streaming ? writeInteriorTile<Streaming>(ids, out.tets)
                             : writeInteriorTile<Cached>(ids, out.tets);
}

void TileEmitter::emitSurfacePoints(const Coord& tile, TileRef record, TileRef surface, Output& out) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        const TileMask& used = usedIn(record, surface, lattice);
        std::int64_t move = mVertices.firstMove(surface, lattice);
        const Vec3d origin(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z());
        Vec3d* const first = out.points;
        emitPoints(0, tile, lattice, used, false, out);
        mVertices.moved(surface, lattice).forEach([&](int n) {
            const Vec3d home = homeOf(localIndex(lattice, n));
            const Vec3d to = home + mVertices.move(move++);
            if (used.test(n)) first[used.rank(n)] = mFrame.world(origin + to);
        });
    }
    const TileChanges* changes = mVertices.changesOf(surface);
    if (!changes) return;
    const Vec3d* const points =
        out.points - usedIn(record, surface, bcc::A).count() - usedIn(record, surface, bcc::B).count();
    for (const std::uint16_t copy : changes->copies) {
        const int lattice = copy >> 9, n = copy & 511;
        const TileMask& used = usedIn(record, surface, lattice);
        *out.points++ =
            points[(lattice == bcc::B ? usedIn(record, surface, bcc::A).count() : 0) + used.rank(n)];
    }
}

/// The places in the lattice of the vertices @a used of a tile.
void TileEmitter::emitPoints(int tier, const Coord& tile, int lattice, const TileMask& used, bool streaming,
                             Output& out) {
    for (int row = 0; row < 64; ++row) {
        const unsigned bits = unsigned(used.words[row >> 3] >> (8 * (row & 7)) & 0xff);
        emitRow(tier, tile, lattice, row, bits, streaming, out.points);
        out.points += countBits(bits);
    }
}

/// Those of a row. The sums are those of Frame::world(), in its order.
void TileEmitter::emitRow(int tier, const Coord& tile, int lattice, int row, unsigned used, bool streaming,
                          Vec3d* points) const {
    if (used == 0) return;
    const double unit = double(std::int64_t(1) << 3 * tier), shift = 0.5 * lattice;
    const double x = unit * (8.0 * tile.x() + ((row >> 3) + shift)),
                 y = unit * (8.0 * tile.y() + ((row & 7) + shift)), z = 8.0 * tile.z();
    double start[3], step[3];
    for (int i = 0; i < 3; ++i) {
        start[i] = mFrame.toWorld(i, 0) * x + mFrame.toWorld(i, 1) * y;
        step[i] = mFrame.toWorld(i, 2);
    }
    double places[8][3];
    for (int k = 0; k < 8; ++k) {
        for (int i = 0; i < 3; ++i)
            places[k][i] = start[i] + step[i] * (unit * (z + (k + shift))) + mFrame.origin[i];
    }
    for (; used != 0; used &= used - 1, ++points) {
        const auto& place = places[lowestBit(used)];
        for (int i = 0; i < 3; ++i) {
            if (streaming) {
                stream(points->asPointer() + i, place[i]);
            } else {
                (*points)[i] = place[i];
            }
        }
    }
}

void TileEmitter::findBoundary(TileRef surface) {
    mFaces.clear();
    if (mVertices.changesOf(surface) || mStates.manifoldMask(bcc::A).any() ||
        mStates.manifoldMask(bcc::B).any())
        findChangedFaces(mVertices, surface, mTets, mStates, mFaces);
}

void TileEmitter::emitBoundary(TileRef record, TileRef surface, ChunkBoundary& boundary) {
    const std::int64_t* ids = mIds.local();
    const TileChanges* changes = mVertices.changesOf(surface);
    for (int lattice = 0; lattice < 2; ++lattice) {
        TileMask onSurface = mVertices.labels.manifold[surface][lattice];
        if (changes) onSurface = (onSurface | changes->exposed[lattice]) & ~changes->buried[lattice];
        (usedIn(record, surface, lattice) & onSurface).forEach([&](int n) {
            boundary.points.push_back(ids[localIndex(lattice, n)]);
        });
    }
    const std::size_t first = boundary.triangles.size();
    for (const LocalFace& face : mFaces)
        boundary.triangles.push_back({ids[face[0]], ids[face[1]], ids[face[2]]});
    if (!changes) return;
    for (std::size_t i = 0; i < changes->copies.size(); ++i) {
        const int vertex = localIndex(changes->copies[i] >> 9, changes->copies[i] & 511);
        boundary.points.push_back(mIds.copyOf(vertex, int(i)));
    }
    for (std::size_t i = 0; i < mFaces.size(); ++i) {
        LocalFace face = mFaces[i];
        std::sort(face.begin(), face.end());
        const auto copies = std::equal_range(changes->faceCopies.begin(), changes->faceCopies.end(),
                                             TileChanges::FaceCopy{face, {}},
                                             [](const auto& a, const auto& b) { return a.face < b.face; });
        for (auto copy = copies.first; copy != copies.second; ++copy) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (mFaces[i][k] == copy->copy.vertex)
                    boundary.triangles[first + i][k] = mIds.copyOf(copy->copy.vertex, copy->copy.number);
            }
        }
    }
}

void TileEmitter::emitCells(TileRef surface, Output& out) {
    mIds.findAll();
    const std::int64_t* ids = mIds.local();
    const TileChanges* changes = mVertices.changesOf(surface);
    const bool hasCopies = changes && !changes->tetCopies.empty();
    Tet* const first = out.tets;
    out.tets = out.streaming && !hasCopies ? writeSurfaceTile<Streaming>(mTets, ids, out.tets)
                                           : writeSurfaceTile<Cached>(mTets, ids, out.tets);
    if (hasCopies) putCopies(*changes, first);
    if (mGrading.top == 0) return;
    forEachTetOfFringe(mOctants, mStates.interiorMask(bcc::B).core(),
                       [&](TetKind, int a, int b, int c, int d) {
                           *out.tets++ = {ids[localIndex(bcc::B, a)], mIds.at(b), mIds.at(c), mIds.at(d)};
                       });
}

void TileEmitter::putCopies(const TileChanges& changes, Tet* tets) const {
    const auto lower = [](const TileChanges::TetCopy& a, const TileChanges::TetCopy& b) {
        return a.tet < b.tet;
    };
    mTets.forEachCode([&](TetCode code) {
        Tet& tet = *tets++;
        const auto copies = std::equal_range(changes.tetCopies.begin(), changes.tetCopies.end(),
                                             TileChanges::TetCopy{code, {}}, lower);
        for (auto copy = copies.first; copy != copies.second; ++copy) {
            const LocalTet corners = mTets.tetOf(code);
            for (int i = 0; i < 4; ++i) {
                if (corners.vertex(i) == copy->copy.vertex)
                    tet[std::size_t(i)] = mIds.copyOf(copy->copy.vertex, copy->copy.number);
            }
        }
    });
}

void TileEmitter::emitOctants(Output& out) {
    for (int level = 1; level <= mOctants.coarsest(); ++level) {
        forEachTetOfLevel(mOctants, level, [&](TetKind, int a, int b, int c, int d) {
            *out.tets++ = {mIds.at(a), mIds.at(b), mIds.at(c), mIds.at(d)};
        });
    }
}

void TileEmitter::addRunShapes(const Coord& tile, TetShapes& shapes) {
    mLocalTets.resize(std::size_t(mNumbering.runTets));
    writeInteriorTile<Cached>(kLocalNumbers.data(), mLocalTets.data());
    for (const Tet& tet : mLocalTets) {
        shapes.add(mFrame, originOf(tile, 1.0),
                   {homeOf(int(tet[0])), homeOf(int(tet[1])), homeOf(int(tet[2])), homeOf(int(tet[3]))},
                   TetKind::Lattice);
    }
}

void TileEmitter::addCellShapes(const Coord& tile, TileRef surface, TetShapes& shapes) {
    const Vec3d origin = originOf(tile, 1.0);
    mLocalTets.resize(std::size_t(mTets.tets()));
    writeSurfaceTile<Cached>(mTets, kLocalNumbers.data(), mLocalTets.data());
    const LocalPositions& positions = mMeasurer.positions();
    for (const Tet& tet : mLocalTets) {
        const int a = int(tet[0]), b = int(tet[1]), c = int(tet[2]), d = int(tet[3]);
        if (surface >= 0) {
            shapes.add(mFrame, origin, {positions[a], positions[b], positions[c], positions[d]});
        } else {
            shapes.add(mFrame, origin, {homeOf(a), homeOf(b), homeOf(c), homeOf(d)}, TetKind::Lattice);
        }
    }
    if (mGrading.top == 0) return;
    forEachTetOfFringe(
        mOctants, mStates.interiorMask(bcc::B).core(), [&](TetKind kind, int a, int b, int c, int d) {
            shapes.add(mFrame, origin, {homeOf(localIndex(bcc::B, a)), placeOf(b), placeOf(c), placeOf(d)},
                       kind);
        });
}

void TileEmitter::addOctantShapes(int tier, const Coord& tile, TetShapes& shapes) const {
    const double unit = double(std::int64_t(1) << 3 * tier);
    const Vec3d origin = originOf(tile, unit);
    for (int level = 1; level <= mOctants.coarsest(); ++level) {
        forEachTetOfLevel(mOctants, level, [&](TetKind kind, int a, int b, int c, int d) {
            shapes.add(mFrame, origin,
                       {unit * placeOf(a), unit * placeOf(b), unit * placeOf(c), unit * placeOf(d)}, kind);
        });
    }
}

} // namespace vdbtet
