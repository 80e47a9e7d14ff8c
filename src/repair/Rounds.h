/// @file Rounds.h
/// Fills and removals around bad vertices, a round at a time.
#pragma once

#include "Parallel.h"
#include "repair/StarReader.h"

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbtet {

/// Tets to put in, or to take out.
struct Candidate {
    double volume = 0.0;
    std::vector<std::int64_t> tets;     ///< TetId, ascending; empty for none
    std::vector<std::int64_t> vertices; ///< VertexId of theirs, ascending
};

class Rounds {
public:
    /// @param bad  the bad vertices, ascending
    Rounds(const Vertices& vertices, const Flips& flips, std::vector<std::int64_t> bad);

    /// Fill until no vertex has a candidate.
    void fill(Interrupt& interrupt) { run(&Rounds::bestFill, interrupt); }
    /// Take tets out until no vertex has a candidate.
    void peel(Interrupt& interrupt) { run(&Rounds::bestPeel, interrupt); }

    const ToggledTets& toggled() const { return mToggled; }
    const std::vector<std::int64_t>& bad() const { return mBad; }
    /// The vertices of all tets that were put in or taken out, ascending.
    const std::vector<std::int64_t>& changed() const { return mChanged; }

    /// @return whether a candidate was given up as no surface tile owns some of its tets.
    bool leavesSurface() const { return mLeavesSurface; }

    void read(std::int64_t vertex, Star& star) { reader().read(vertex, mToggled, star); }
    StarReader& reader() { return *mReaders.local(); }

private:
    using Choose = Candidate (Rounds::*)(const Star& star);

    void run(Choose choose, Interrupt& interrupt);
    Candidate bestFill(const Star& star);
    Candidate bestPeel(const Star& star);

    /// The candidate of some tets of a star.
    Candidate candidate(const Star& star, LinkMask tets);
    /// Whether the tets of a star are good ones: not inverted, and with angles within Theorem 3's bound.
    bool areGood(const Star& star, LinkMask tets);
    /// Whether filling makes the sum of the badness of all vertices smaller.
    bool helps(const Candidate& fill);
    /// Whether two wedges about an edge of the star are in one fan at its other end, too.
    bool joinedBeyond(const Star& star, int linkVertex, LinkMask wedge, LinkMask fan);
    void apply(const std::vector<Candidate>& winners);

    ToggledTets mToggled;
    std::vector<std::int64_t> mBad, mChanged;
    std::atomic<bool> mLeavesSurface{false};
    tbb::enumerable_thread_specific<std::unique_ptr<StarReader>> mReaders;
};

} // namespace vdbtet
