/// @file BoundaryCheck.cc
/// Reads the stars of the suspects.
#include "repair/BoundaryCheck.h"

#include "repair/Link.h"
#include "tets/Stars.h"

#include <tbb/enumerable_thread_specific.h>

#include <memory>

namespace vdbtet {

namespace {

/// Looks at one tile after another; one for each thread.
class PinchFinder {
public:
    PinchFinder(const Vertices& vertices, const Flips& flips) : mVertices(vertices), mStars(vertices, flips) {
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            const int v = localIndex(lattice, 3, 3, 3); // any
            mStars.forEachLatticeTet(
                v, [&](const std::array<int, 4>& tet) { mRegular[lattice].add(faceOpposite(tet, v)); });
            mRegular[lattice].close();
        }
    }

    /// Look at some manifold vertices of a tile.
    void find(const Suspects& suspects, std::vector<std::int64_t>& found) {
        const TileRef tile = suspects.tile;
        mStates.load(mVertices, tile);
        mStars.load(tile, mStates);
        for (const bcc::Lattice lattice : {bcc::A, bcc::B}) {
            suspects.vertices[lattice].forEach([&](int n) {
                if (isPinched(localIndex(lattice, n))) found.push_back(VertexId::of(tile, lattice, n));
            });
        }
    }

private:
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
};

std::vector<Suspects> suspectsOf(const Vertices& vertices, const Flips& flips, Interrupt& interrupt) {
    if (flips.lastResort == 0) return flips.suspects ? *flips.suspects : findSuspects(vertices, interrupt);
    // Suspects do without what the last resort has done, which is so rare that then all are.
    std::vector<Suspects> all;
    for (TileRef t = 0; t < vertices.layout.ownCount(); ++t) {
        if (vertices.destinations.any(t)) all.push_back({t, vertices.labels.manifold[t]});
    }
    return all;
}

} // namespace

std::vector<std::int64_t> findPinched(const Vertices& vertices, const Flips& flips, Interrupt& interrupt) {
    interrupt.expectLoops(flips.suspects ? 1 : 2);
    const std::vector<Suspects> suspects = suspectsOf(vertices, flips, interrupt);
    std::vector<std::vector<std::int64_t>> found(suspects.size());
    tbb::enumerable_thread_specific<std::unique_ptr<PinchFinder>> finders(
        [&] { return std::make_unique<PinchFinder>(vertices, flips); });
    parallelRanges(std::int64_t(found.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        PinchFinder& finder = *finders.local();
        for (std::int64_t i = begin; i < end; ++i) finder.find(suspects[i], found[i]);
    });
    std::vector<std::int64_t> pinched;
    for (const auto& some : found) pinched.insert(pinched.end(), some.begin(), some.end());
    return pinched;
}

} // namespace vdbtet
