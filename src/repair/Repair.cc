/// @file Repair.cc
/// The order of the steps.
#include "repair/Repair.h"

#include "repair/ChangesMaker.h"
#include "repair/Rounds.h"

#include <utility>

namespace vdbtet {

Repair repairBoundary(const Vertices& vertices, const Flips& flips, Boundary mode, Interrupt& interrupt) {
    Repair repair;
    std::vector<std::int64_t> bad = findPinched(vertices, flips, interrupt);
    repair.counts.found = repair.counts.left = std::int64_t(bad.size());
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
    return repair;
}

} // namespace vdbtet
