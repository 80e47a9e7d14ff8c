/// @file TileEmitter.cc
/// Ids by rank, whole octahedra at a time.
#include "emit/TileEmitter.h"

#include "simd/Stream.h"

namespace vdbtet {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

const TileMask kNone = TileMask::filled(false), kAll = TileMask::filled(true);

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
        TileMask some = flipped, whole = TileMask::filled(true);
        for (int number = 0; number < 4; ++number) {
            some |= found.latticeTets(kAxis, number);
            whole &= found.latticeTets(kAxis, number);
        }
        some.forEach([&](int n) {
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

} // namespace

Output TileEmitter::emit(std::int64_t span, std::int64_t offset, Output out) {
    const Layout::Span& s = mVertices.layout.spans[span];
    const Coord tile = s.first.offsetBy(0, 0, int(offset));
    findIds(tile);
    if (s.surface >= 0) {
        emitSurfaceTile(tile, s.surface, out);
    } else {
        emitInteriorTile(tile, out);
    }
    return out;
}

void TileEmitter::measure(TileRef surface) {
    mStates.load(mVertices, surface);
    mTets.load(surface, mStates);
    mMeasurer.measure(surface, mTets, mStates);
}

void TileEmitter::emitSurfaceTile(const Coord& tile, TileRef surface, Output& out) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        const TileMask& used = mNumbering.used[surface][lattice];
        const TileMask& manifold = mVertices.labels.manifold[surface][lattice];
        std::int64_t move = mVertices.destinations.first[surface][lattice];
        const Vec3d origin(8.0 * tile.x(), 8.0 * tile.y(), 8.0 * tile.z());
        Vec3d* first = out.points;
        for (int row = 0; row < 64; ++row) {
            const unsigned bits = unsigned(used.words[row >> 3] >> (8 * (row & 7)) & 0xff);
            emitRow(tile, lattice, row, bits, false, out.points);
            out.points += countBits(bits);
        }
        manifold.forEach([&](int n) {
            const Vec3d home = homeOf(localIndex(lattice, n));
            const Vec3d to = home + mVertices.destinations.move(move++);
            if (used.test(n)) first[used.rank(n)] = mFrame.world(origin + to);
        });
    }
    measure(surface);
    out.tets = out.streaming ? writeSurfaceTile<Streaming>(mTets, mIds.data(), out.tets)
                             : writeSurfaceTile<Cached>(mTets, mIds.data(), out.tets);
}

void TileEmitter::emitInteriorTile(const Coord& tile, Output& out) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        for (int row = 0; row < 64; ++row, out.points += 8)
            emitRow(tile, lattice, row, 0xff, out.streaming, out.points);
    }
    out.tets = out.streaming ? writeInteriorTile<Streaming>(mIds.data(), out.tets)
                             : writeInteriorTile<Cached>(mIds.data(), out.tets);
}

/// The places in the lattice of the vertices @a used of a row. The sums are those of Frame::world(), in its
/// order.
void TileEmitter::emitRow(const Coord& tile, int lattice, int row, unsigned used, bool streaming,
                          Vec3d* points) const {
    if (used == 0) return;
    const double shift = 0.5 * lattice, x = 8.0 * tile.x() + ((row >> 3) + shift),
                 y = 8.0 * tile.y() + ((row & 7) + shift), z = 8.0 * tile.z();
    double start[3], step[3];
    for (int i = 0; i < 3; ++i) {
        start[i] = mFrame.toWorld(i, 0) * x + mFrame.toWorld(i, 1) * y;
        step[i] = mFrame.toWorld(i, 2);
    }
    double places[8][3];
    for (int k = 0; k < 8; ++k) {
        for (int i = 0; i < 3; ++i) places[k][i] = start[i] + step[i] * (z + (k + shift)) + mFrame.origin[i];
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

TileEmitter::Ids TileEmitter::idsOf(std::int64_t span, int tileZ) const {
    Ids ids;
    ids.used[bcc::A] = ids.used[bcc::B] = &kNone;
    if (span < 0) return ids;
    const Layout::Span& s = mVertices.layout.spans[span];
    ids.first[bcc::A] = mNumbering.firstPoint[span];
    if (s.surface < 0) {
        ids.first[bcc::A] += kInteriorPoints * (std::int64_t(tileZ) - s.first.z());
        ids.used[bcc::A] = ids.used[bcc::B] = &kAll;
    } else {
        for (int lattice = 0; lattice < 2; ++lattice)
            ids.used[lattice] = &mNumbering.used[s.surface][lattice];
    }
    ids.first[bcc::B] = ids.first[bcc::A] + ids.used[bcc::A]->count();
    return ids;
}

void TileEmitter::findIds(const Coord& tile) {
    const auto spans = mVertices.layout.spansAround(tile);
    for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
            Ids column[3];
            for (int dz = -1; dz <= 1; ++dz)
                column[dz + 1] = idsOf(spans[neighbourSlot(dx, dy, dz)], tile.z() + dz);
            const int x0 = dx < 0 ? -1 : 8 * dx, x1 = dx == 0 ? 7 : x0;
            const int y0 = dy < 0 ? -1 : 8 * dy, y1 = dy == 0 ? 7 : y0;
            for (int lattice = 0; lattice < 2; ++lattice) {
                for (int x = x0; x <= x1; ++x) {
                    Slab slabs[3];
                    for (int z = 0; z < 3; ++z) slabs[z] = slabOf(column[z], lattice, x & 7);
                    for (int y = y0; y <= y1; ++y)
                        findIds(slabs, y & 7, mIds.data() + localIndex(lattice, x, y, 0));
                }
            }
        }
    }
}

TileEmitter::Slab TileEmitter::slabOf(const Ids& ids, int lattice, int x) {
    const TileMask& used = *ids.used[lattice];
    return {ids.first[lattice] + used.rank(x << 6), used.words[x]};
}

/// The ids of a row from -1 to 8 in three tiles above each other.
void TileEmitter::findIds(const Slab (&slabs)[3], int y, std::int64_t* row) {
    const auto idAt = [&](const Slab& slab, int n) {
        return slab.first + countBits(slab.used & ((std::uint64_t(1) << n) - 1));
    };
    row[-1] = idAt(slabs[0], 8 * y + 7);
    const std::int64_t before = idAt(slabs[1], 8 * y);
    const unsigned bits = unsigned(slabs[1].used >> (8 * y) & 0xff);
    if (bits == 0xff) {
        for (int z = 0; z < 8; ++z) row[z] = before + z;
    } else {
        for (int z = 0; z < 8; ++z) row[z] = before + countBits(bits & ((1u << z) - 1));
    }
    row[8] = idAt(slabs[2], 8 * y);
}

} // namespace vdbtet
