/// @file BoundaryCheck.cc
/// Looks at the surroundings of each manifold vertex as a pattern of bits. The same few patterns come again
/// and again, so the stars of most vertices are never read.
#include "repair/BoundaryCheck.h"

#include "repair/Link.h"
#include "tets/Stars.h"

#include <tbb/enumerable_thread_specific.h>

#include <memory>

namespace vdbtet {

namespace {

/// All that the star of a vertex depends on.
struct Pattern {
    std::uint64_t own = 0, others = 0; ///< interior and manifold vertices around
    std::uint64_t slices = 0;

    friend bool operator==(const Pattern& a, const Pattern& b) {
        return a.own == b.own && a.others == b.others && a.slices == b.slices;
    }
};

/// Vertices about a vertex of the same lattice, in three rows of 16 bits at each of three x.
using OwnRows = std::array<std::uint64_t, 3>;

constexpr void setBit(OwnRows& rows, int dx, int dy, int dz) {
    rows[std::size_t(dx + 1)] |= std::uint64_t(1) << (16 * (dy + 1) + dz + 1);
}

/// The ends of long edges.
constexpr OwnRows longEdges() {
    OwnRows rows{};
    for (const int step : {-1, 1}) {
        setBit(rows, step, 0, 0);
        setBit(rows, 0, step, 0);
        setBit(rows, 0, 0, step);
    }
    return rows;
}
constexpr OwnRows kLongEdges = longEdges();

/// The far end of the new edge from a vertex, by its lattice, its role in an octahedron and the
/// slice.
using FarEnds = std::array<std::array<std::array<OwnRows, 3>, kRoles>, 2>;
constexpr FarEnds farEnds() {
    FarEnds ends{};
    for (const bcc::Lattice spine : {bcc::A, bcc::B}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bcc::Octahedron& octahedron = bcc::kOctahedra[spine][axis];
            for (std::size_t i = 2; i < 6; ++i) {
                const bcc::Vertex& v = octahedron[i];
                const auto role = std::size_t(kRolesOf[spine][axis][i]);
                const bcc::Vertex& o = octahedron[2 + i % 4]; // across the ring
                const auto slice = std::size_t(i % 2 == 0 ? bcc::SliceA : bcc::SliceB);
                setBit(ends[v.lattice][role][slice], o.x - v.x, o.y - v.y, o.z - v.z);
            }
        }
    }
    return ends;
}
constexpr FarEnds kFarEnds = farEnds();

/// Bits of two rows, of the vertices of the other lattice.
constexpr std::uint64_t kOtherRows = 0x00030003;

/// @return three rows from that of bit @a lowest on, from that bit on.
std::uint64_t rowsAt(const PaddedMask& mask, int lowest) {
    const std::uint16_t* row = mask.rows + lowest / PaddedMask::kRowBits;
    const std::uint64_t rows = row[0] | std::uint64_t(row[1]) << 16 | std::uint64_t(row[2]) << 32;
    return rows >> (unsigned(lowest) % PaddedMask::kRowBits);
}

/// Looks at one tile after another; one for each thread.
class PinchFinder {
public:
    PinchFinder(const Vertices& vertices, const Flips& flips)
        : mVertices(vertices), mStars(vertices, flips), mKnown(std::size_t(1) << kKnownBits) {
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            const int v = localIndex(lattice, 3, 3, 3); // any
            mStars.forEachLatticeTet(
                v, [&](const std::array<int, 4>& tet) { mRegular[lattice].add(faceOpposite(tet, v)); });
            mRegular[lattice].close();
        }
    }

    void find(TileRef tile, std::vector<std::int64_t>& found) {
        if (!mVertices.destinations.any(tile)) return;
        mStates.load(mVertices, tile);
        mStars.load(tile, mStates);
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            mVertices.labels.manifold[tile][lattice].forEach([&](int n) {
                const int v = localIndex(lattice, n);
                const Pattern pattern = patternOf(v);
                Known& known = mKnown[hash(pattern)];
                if (!known.any || !(known.pattern == pattern)) known = {pattern, true, isPinched(v)};
                if (known.pinched) found.push_back(VertexId::of(tile, lattice, n));
            });
        }
    }

private:
    /// A pattern that has been looked at.
    struct Known {
        Pattern pattern;
        bool any = false;
        bool pinched = false;
    };
    static constexpr unsigned kKnownBits = 13;

    static std::size_t hash(const Pattern& pattern) {
        const std::uint64_t mixed =
            ((pattern.own * 0x9e3779b97f4a7c15u ^ pattern.others) * 0xbf58476d1ce4e5b9u ^ pattern.slices) *
            0x94d049bb133111ebu;
        return std::size_t(mixed >> (64 - kKnownBits));
    }

    Pattern patternOf(int v) const {
        constexpr int kSlab = PaddedMask::kSlabBits;
        const bcc::Lattice lattice = latticeOf(v), other = bcc::other(lattice);
        const int lowest = bitOf(v) - PaddedMask::step(1, 1, 1),
                  lowestOther = lattice == bcc::A ? lowest : bitOf(v);
        Pattern pattern;
        pattern.slices = mStars.slicesAt(v);
        OwnRows matters = kLongEdges;
        for (std::uint64_t left = pattern.slices; left != 0;) {
            const int role = lowestBit(left) / 2;
            const std::uint64_t slice = left >> (2 * role) & 3;
            for (std::size_t x = 0; x < 3; ++x) matters[x] |= kFarEnds[lattice][std::size_t(role)][slice][x];
            left &= ~(std::uint64_t(3) << (2 * role));
        }
        const PaddedMask &interior = mStates.interiorMask(lattice), &manifold = mStates.manifoldMask(lattice);
        // Of 16 bits of a row at most three are set: there is room for five.
        pattern.own = (rowsAt(interior, lowest) & matters[0]) |
                      (rowsAt(interior, lowest + kSlab) & matters[1]) << 3 |
                      (rowsAt(interior, lowest + 2 * kSlab) & matters[2]) << 6 |
                      (rowsAt(manifold, lowest) & matters[0]) << 9 |
                      (rowsAt(manifold, lowest + kSlab) & matters[1]) << 12;
        const PaddedMask &interiorB = mStates.interiorMask(other), &manifoldB = mStates.manifoldMask(other);
        pattern.others = (rowsAt(manifold, lowest + 2 * kSlab) & matters[2]) |
                         (rowsAt(interiorB, lowestOther) & kOtherRows) << 3 |
                         (rowsAt(interiorB, lowestOther + kSlab) & kOtherRows) << 5 |
                         (rowsAt(manifoldB, lowestOther) & kOtherRows) << 7 |
                         (rowsAt(manifoldB, lowestOther + kSlab) & kOtherRows) << 9;
        return pattern;
    }

    bool isPinched(int v) {
        LinkMask in = 0;
        if (mStars.slicesAt(v) == 0) {
            int triangle = 0;
            mStars.forEachTet(v, [&](const StarTet& tet) {
                in |= LinkMask(tet.presence == Presence::InMesh) << triangle++;
            });
            return mRegular[latticeOf(v)].badness(in) > 0;
        }
        mLink.clear();
        mStars.forEachTet(v, [&](const StarTet& tet) {
            if (tet.presence == Presence::InMesh) in |= LinkMask(1) << mLink.triangles();
            mLink.add(faceOpposite(tet.vertices, v));
        });
        mLink.close();
        return mLink.badness(in) > 0;
    }

    const Vertices& mVertices;
    LocalStates mStates;
    Stars mStars;
    std::array<Link, 2> mRegular; ///< where nothing is flipped, by lattice
    Link mLink;                   ///< elsewhere
    std::vector<Known> mKnown;
};

} // namespace

std::vector<std::int64_t> findPinched(const Vertices& vertices, const Flips& flips, Interrupt& interrupt) {
    const std::int64_t tiles = vertices.layout.ownCount();
    std::vector<std::vector<std::int64_t>> found(tiles);
    tbb::enumerable_thread_specific<std::unique_ptr<PinchFinder>> finders(
        [&] { return std::make_unique<PinchFinder>(vertices, flips); });
    interrupt.expectLoops(1);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        PinchFinder& finder = *finders.local();
        for (std::int64_t t = begin; t < end; ++t) finder.find(TileRef(t), found[t]);
    });
    std::vector<std::int64_t> pinched;
    for (const auto& some : found) pinched.insert(pinched.end(), some.begin(), some.end());
    return pinched;
}

} // namespace vdbtet
