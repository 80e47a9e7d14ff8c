/// @file Repair.cc
/// The order of the steps.
#include "repair/Repair.h"

#include "repair/ChangesMaker.h"
#include "repair/Rounds.h"

#include <algorithm>
#include <utility>

namespace vdbtet {

namespace {

/// In units of the lattice.
openvdb::Vec3d positionOf(const Vertices& vertices, std::int64_t id) {
    const TileRef tile = VertexId::tile(id);
    const int lattice = VertexId::lattice(id), bit = VertexId::bit(id);
    const openvdb::Vec3d home = vertices.layout.origin(tile) + homeOf(VertexId::local(id));
    const TileMask& moved = vertices.moved(tile, lattice);
    if (!moved.test(bit)) return home;
    return home + vertices.move(vertices.firstMove(tile, lattice) + moved.rank(bit));
}

} // namespace

Repair repairBoundary(const Vertices& vertices, const Flips& flips, Boundary mode, Interrupt& interrupt) {
    return mendBoundary(vertices, flips, findPinched(vertices, flips, interrupt), mode, interrupt);
}

Repair mendBoundary(const Vertices& vertices, const Flips& flips, std::vector<std::int64_t> bad,
                    Boundary mode, Interrupt& interrupt) {
    Repair repair;
    repair.counts.found = repair.counts.left = std::int64_t(bad.size());
    for (std::size_t i = 0; i < std::min(bad.size(), Places::kMost); ++i)
        repair.pinched.push_back(positionOf(vertices, bad[i]));
    if (bad.empty() || mode == Boundary::Raw || interrupt.stopped()) return repair;

    Rounds rounds(vertices, flips, std::move(bad));
    rounds.fill(interrupt);
    if (mode == Boundary::Manifold) rounds.peel(interrupt);
    if (interrupt.stopped()) return repair;
    ChangesMaker maker(vertices, rounds);
    maker.addTets(repair.counts);
    if (mode == Boundary::Manifold) maker.split(repair.counts);
    // Nothing is left to peel, so that all that is bad is a vertex of several fans, each a disc.
    repair.counts.left = mode == Boundary::Manifold ? 0 : std::int64_t(rounds.bad().size());
    repair.leavesSurface = rounds.leavesSurface() || maker.leavesSurface();
    repair.changes = maker.take();
    repair.changed = rounds.changed();
    return repair;
}

} // namespace vdbtet
