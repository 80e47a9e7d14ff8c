/// @file Rounds.cc
/// Candidates by masks of the link; claims by the lowest vertex.
#include "repair/Rounds.h"

#include "quality/Dihedral.h"

#include <vdbtet/Quality.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace vdbtet {

namespace {

constexpr double kDegree = 0.017453292519943295;
/// Theorem 3's bound.
const double kMostCosine = std::cos(11.47 * kDegree), kLeastCosine = std::cos(157.59 * kDegree);

int lowest(LinkMask mask) { return __builtin_ctzll(mask); }

/// Call @a visit(part) for the parts that @a mask falls into by @a joined(from, among).
template <typename Joined, typename Visit>
void forEachPart(LinkMask mask, Joined&& joined, Visit&& visit) {
    while (mask != 0) {
        const LinkMask part = joined(lowest(mask), mask);
        mask &= ~part;
        visit(part);
    }
}

void sortUnique(std::vector<std::int64_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// @return what is in exactly one of two ascending lists.
std::vector<std::int64_t> toggle(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
    std::vector<std::int64_t> result;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

} // namespace

Rounds::Rounds(const Vertices& vertices, const Flips& flips, std::vector<std::int64_t> bad)
    : mBad(std::move(bad)),
      mReaders([&vertices, &flips] { return std::make_unique<StarReader>(vertices, flips); }) {}

void Rounds::run(Choose choose, Interrupt& interrupt) {
    // A vertex whose surroundings have not changed since it had no candidate has none.
    std::vector<std::int64_t> open = mBad;
    while (!open.empty() && !interrupt.poll()) {
        std::vector<Candidate> candidates(open.size());
        parallelRanges(std::int64_t(open.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
            Star star;
            for (std::int64_t i = begin; i < end; ++i) {
                read(open[i], star);
                candidates[i] = (this->*choose)(star);
            }
        });
        if (interrupt.stopped()) return;

        std::unordered_map<std::int64_t, std::int64_t> claims; // the lowest claimant of a vertex
        for (std::size_t i = open.size(); i-- > 0;) {
            for (const std::int64_t v : candidates[i].vertices) claims[v] = open[i];
        }
        std::vector<Candidate> winners;
        std::vector<std::int64_t> losers;
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (candidates[i].tets.empty()) continue;
            const auto& vertices = candidates[i].vertices;
            const bool wins = std::all_of(vertices.begin(), vertices.end(),
                                          [&](std::int64_t v) { return claims[v] == open[i]; });
            if (wins) {
                winners.push_back(std::move(candidates[i]));
            } else {
                losers.push_back(open[i]);
            }
        }
        apply(winners);

        // Those near a change: their candidates, and what these would mend, are within two edges.
        std::vector<std::int64_t> near = losers;
        Star star;
        for (const Candidate& winner : winners) {
            for (const std::int64_t v : winner.vertices) {
                read(v, star);
                for (int l = 0; l < star.link.vertices(); ++l) {
                    const std::int64_t id = reader().idOf(star.tile, star.link.name(l));
                    if (id >= 0) near.push_back(id);
                }
                near.push_back(v);
            }
        }
        sortUnique(near);
        open.clear();
        std::set_intersection(near.begin(), near.end(), mBad.begin(), mBad.end(), std::back_inserter(open));
    }
}

void Rounds::apply(const std::vector<Candidate>& winners) {
    std::vector<std::int64_t> tets, vertices;
    for (const Candidate& winner : winners) {
        tets.insert(tets.end(), winner.tets.begin(), winner.tets.end());
        vertices.insert(vertices.end(), winner.vertices.begin(), winner.vertices.end());
    }
    sortUnique(tets);
    sortUnique(vertices);
    mToggled = toggle(mToggled, tets);

    mChanged.insert(mChanged.end(), vertices.begin(), vertices.end());
    sortUnique(mChanged);

    std::vector<std::int64_t> others, bad;
    std::set_difference(mBad.begin(), mBad.end(), vertices.begin(), vertices.end(),
                        std::back_inserter(others));
    Star star;
    for (const std::int64_t v : vertices) {
        read(v, star);
        if (star.link.badness(star.in) > 0) bad.push_back(v);
    }
    mBad.clear();
    std::merge(others.begin(), others.end(), bad.begin(), bad.end(), std::back_inserter(mBad));
}

Candidate Rounds::candidate(const Star& star, LinkMask tets) {
    Candidate result;
    const auto at = [&](int local) { return reader().position(star, local); };
    for (; tets != 0; tets &= tets - 1) {
        const int t = lowest(tets);
        const auto& v = star.tets[std::size_t(t)].vertices;
        result.volume += signedVolume6(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
        result.tets.push_back(star.ids[std::size_t(t)]);
        for (const int local : v) {
            const std::int64_t id = reader().idOf(star.tile, local);
            if (id >= 0) result.vertices.push_back(id);
        }
    }
    sortUnique(result.tets);
    sortUnique(result.vertices);
    return result;
}

bool Rounds::areGood(const Star& star, LinkMask tets) {
    const auto at = [&](int local) { return reader().position(star, local); };
    for (; tets != 0; tets &= tets - 1) {
        const auto& v = star.tets[std::size_t(lowest(tets))].vertices;
        if (!(signedVolume6(at(v[0]), at(v[1]), at(v[2]), at(v[3])) > 0.0)) return false;
        for (const double cosine : dihedralCosines(at(v[0]), at(v[1]), at(v[2]), at(v[3]))) {
            if (!(cosine < kMostCosine && cosine > kLeastCosine)) return false;
        }
    }
    return true;
}

bool Rounds::helps(const Candidate& fill) {
    int change = 0;
    Star star;
    for (const std::int64_t v : fill.vertices) {
        read(v, star);
        LinkMask filled = star.in;
        for (const std::int64_t tet : fill.tets) {
            const int t = star.find(tet);
            if (t >= 0) filled |= LinkMask(1) << t;
        }
        change += star.link.badness(filled) - star.link.badness(star.in);
    }
    return change < 0;
}

Candidate Rounds::bestFill(const Star& star) {
    std::vector<LinkMask> gaps;
    const LinkMask out = star.link.all() & ~star.in;
    const auto add = [&](LinkMask gap) {
        if ((gap & ~star.ambiguous) == 0) gaps.push_back(gap);
    };
    forEachPart(
        out, [&](int from, LinkMask among) { return star.link.joined(from, among); }, add);
    for (int v = 0; v < star.link.vertices(); ++v) {
        if (star.link.wedges(v, star.in) < 2) continue;
        forEachPart(
            out & star.link.at(v),
            [&](int from, LinkMask among) { return star.link.joinedAround(v, from, among); }, add);
    }
    for (LinkMask left = star.ambiguous; left != 0; left &= left - 1) gaps.push_back(left & ~(left - 1));
    std::sort(gaps.begin(), gaps.end());
    gaps.erase(std::unique(gaps.begin(), gaps.end()), gaps.end());

    std::vector<Candidate> fills;
    for (const LinkMask gap : gaps) {
        if (areGood(star, gap)) fills.push_back(candidate(star, gap));
    }
    std::sort(fills.begin(), fills.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.volume, a.tets) < std::tie(b.volume, b.tets);
    });
    for (Candidate& fill : fills) {
        if (helps(fill)) return std::move(fill);
    }
    return {};
}

bool Rounds::joinedBeyond(const Star& star, int linkVertex, LinkMask wedge, LinkMask fan) {
    // A vertex that no surface tile has is inside, and its star is one fan.
    const std::int64_t id = reader().idOf(star.tile, star.link.name(linkVertex));
    if (id < 0) return true;
    Star other;
    read(id, other);
    const auto there = [&](LinkMask tets) {
        LinkMask mask = 0;
        for (; tets != 0; tets &= tets - 1) {
            const int t = other.find(star.ids[std::size_t(lowest(tets))]);
            if (t >= 0) mask |= LinkMask(1) << t;
        }
        return mask;
    };
    if (there(wedge) == 0) return true;
    const LinkMask reached = other.link.joined(lowest(there(wedge)), other.in);
    return (reached & there(fan & star.link.at(linkVertex) & ~wedge)) != 0;
}

Candidate Rounds::bestPeel(const Star& star) {
    Candidate best;
    const auto offer = [&](LinkMask tets) {
        Candidate one = candidate(star, tets);
        if (one.tets.front() < 0) {
            mLeavesSurface = true;
            return;
        }
        if (best.tets.empty() || std::tie(one.volume, one.tets) < std::tie(best.volume, best.tets))
            best = std::move(one);
    };
    const auto joined = [&](int from, LinkMask among) { return star.link.joined(from, among); };
    forEachPart(star.in, joined, [&](LinkMask fan) {
        if (star.link.euler(fan) < 1) offer(fan);
        for (int v = 0; v < star.link.vertices(); ++v) {
            if (star.link.wedges(v, fan) < 2) continue;
            forEachPart(
                fan & star.link.at(v),
                [&](int from, LinkMask among) { return star.link.joinedAround(v, from, among); },
                [&](LinkMask wedge) {
                    if (joinedBeyond(star, v, wedge, fan)) offer(wedge);
                });
        }
    });
    return best;
}

} // namespace vdbtet
