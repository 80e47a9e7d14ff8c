// The paper's Algorithms 2 and 3, and the definition that they search for.
#include "reference/ReferenceLabels.h"

#include <algorithm>
#include <stdexcept>

namespace vdbtet::test {

namespace {

constexpr double kTie = 1e-6;

/// The state of the paper's search: an edge is active when it is cut and neither end is manifold.
struct Search {
    const DenseLattice& lattice;
    Labels& labels;

    bool isActive(Vertex v, int d) const {
        return lattice.isCut(v, d) && !labels.manifold(v) && !labels.manifold(lattice.neighbour(v, d));
    }

    int countActive(Vertex v) const {
        int count = 0;
        for (int d = 0; d < kDirections; ++d) count += isActive(v, d);
        return count;
    }

    /// Eq. (6): the active edge at v with the nearest cut point.
    int nearestActive(Vertex v) const {
        int nearest = Labels::kNone;
        for (int d = 0; d < kDirections; ++d)
            if (isActive(v, d) &&
                (nearest == Labels::kNone || lattice.cutDistance(v, d) < lattice.cutDistance(v, nearest)))
                nearest = d;
        return nearest;
    }

    /// The end of the active edge (v1, d) that is to be labelled, with the edge it moves along.
    std::pair<Vertex, int> candidate(Vertex v1, int d) const {
        const Vertex v2 = lattice.neighbour(v1, d);
        const int e1 = nearestActive(v1), e2 = nearestActive(v2);
        const double d1 = lattice.cutDistance(v1, e1), d2 = lattice.cutDistance(v2, e2);
        const bool first = d1 != d2 ? d1 < d2 : countActive(v1) >= countActive(v2);
        return first ? std::make_pair(v1, e1) : std::make_pair(v2, e2);
    }

    /// Algorithm 2.
    void labelInitially() {
        for (const Vertex a : lattice.verticesA())
            for (int d = 0; d < kDirections; ++d)
                if (isActive(a, d)) {
                    const auto [v, edge] = candidate(a, d);
                    labels.move[v] = std::int8_t(edge);
                }
    }

    bool movesTowardManifold(Vertex v) const {
        return labels.manifold(v) && labels.manifold(lattice.neighbour(v, labels.move[v]));
    }

    /// One of the two loops of Algorithm 3.
    void backLabel(const std::vector<Vertex>& side) {
        // What a vertex of this side moves toward is on the other side, and turns manifold in a propagation
        // alone; so only the vertices around it can become offenders, and enter the list anew.
        std::vector<Vertex> offenders;
        for (const Vertex v : side)
            if (movesTowardManifold(v)) offenders.push_back(v);
        while (!offenders.empty()) {
            const Vertex v = offenders.back();
            offenders.pop_back();
            if (!movesTowardManifold(v)) continue;
            labels.move[v] = Labels::kNone;

            std::vector<std::pair<Vertex, int>> candidates;
            for (int d = 0; d < kDirections; ++d)
                if (isActive(v, d)) candidates.push_back(candidate(v, d));
            const auto own = std::find_if(candidates.begin(), candidates.end(),
                                          [&](const auto& c) { return c.first == v; });
            if (own != candidates.end()) {
                labels.move[v] = std::int8_t(own->second);
                continue;
            }
            for (const auto& [other, edge] : candidates) labels.move[other] = std::int8_t(edge);
            for (const auto& [other, edge] : candidates)
                for (int d = 0; d < kDirections; ++d)
                    if (lattice.isCut(other, d)) offenders.push_back(lattice.neighbour(other, d));
        }
        for (const Vertex v : side)
            if (movesTowardManifold(v)) throw std::logic_error("back-labelling left an offender");
    }
};

/// A manifold vertex may move along a cut edge that it is nearer to (or as near: the L_A end), to a vertex
/// that is not manifold.
bool isArrow(const DenseLattice& lattice, const Threshold& threshold, Vertex v, int d, bool inA) {
    const double t = lattice.cutDistance(v, d);
    if (t > 1) return false;
    const double reach = threshold.reach(lattice, v, d);
    return inA ? t <= reach : t < reach;
}

/// The nearest destination of each manifold vertex, ties to the lowest direction number.
void chooseDestinations(const DenseLattice& lattice, const Threshold& threshold, Labels& labels) {
    const auto choose = [&](Vertex v) {
        double nearest = 2;
        const auto leads = [&](int d) {
            return lattice.isCut(v, d) && lattice.cutDistance(v, d) <= threshold.reach(lattice, v, d) &&
                   !labels.manifold(lattice.neighbour(v, d));
        };
        for (int d = 0; d < kDirections; ++d)
            if (leads(d)) nearest = std::min(nearest, lattice.cutDistance(v, d));
        if (nearest > 1) throw std::logic_error("a manifold vertex has no destination");
        int chosen = Labels::kNone, candidates = 0;
        for (int d = 0; d < kDirections; ++d)
            if (leads(d) && lattice.cutDistance(v, d) <= nearest + kTie) {
                ++candidates;
                if (chosen == Labels::kNone) chosen = d;
            }
        labels.destinationTies += candidates > 1;
        const bool stale = candidates == 1 && labels.move[v] != chosen;
        labels.staleDestinations += stale;
        labels.move[v] = std::int8_t(chosen);
    };
    for (const Vertex v : lattice.verticesA())
        if (labels.manifold(v)) choose(v);
    for (const Vertex v : lattice.verticesB())
        if (labels.manifold(v)) choose(v);
}

} // namespace

double Threshold::reach(const DenseLattice& lattice, Vertex v, int direction) const {
    if (!flagged.empty() && (flagged[v] || flagged[lattice.neighbour(v, direction)])) return 0.5;
    return lattice.inside(v) ? tau : 1 - tau;
}

Labels kernelLabels(const DenseLattice& lattice, const Threshold& threshold) {
    enum State : char { Undecided, InKernel, Manifold };
    std::vector<State> state(lattice.size(), Undecided);
    Labels labels;
    labels.move.assign(lattice.size(), Labels::kNone);

    bool changed = true;
    const auto decide = [&](Vertex v, bool inA) {
        if (state[v] != Undecided) return;
        bool sink = true;
        for (int d = 0; d < kDirections; ++d) {
            if (!isArrow(lattice, threshold, v, d, inA)) continue;
            const State to = state[lattice.neighbour(v, d)];
            if (to == InKernel) state[v] = Manifold;
            sink &= to == Manifold;
        }
        if (state[v] == Undecided && sink) state[v] = InKernel;
        changed |= state[v] != Undecided;
    };
    while (changed) {
        changed = false;
        for (const Vertex v : lattice.verticesA()) decide(v, true);
        for (const Vertex v : lattice.verticesB()) decide(v, false);
    }
    const auto settle = [&](const std::vector<Vertex>& side, State left) {
        for (const Vertex v : side) {
            if (state[v] == Undecided) {
                ++labels.undecided;
                state[v] = left;
            }
            if (state[v] == Manifold) labels.move[v] = 0;
        }
    };
    settle(lattice.verticesA(), InKernel);
    settle(lattice.verticesB(), Manifold);
    chooseDestinations(lattice, threshold, labels);
    labels.staleDestinations = 0;
    return labels;
}

Labels searchedLabels(const DenseLattice& lattice) {
    Labels labels;
    labels.move.assign(lattice.size(), Labels::kNone);
    Search search{lattice, labels};
    search.labelInitially();
    search.backLabel(lattice.verticesA());
    search.backLabel(lattice.verticesB());
    chooseDestinations(lattice, {}, labels);
    labels.undecided = kernelLabels(lattice).undecided;
    return labels;
}

} // namespace vdbtet::test
