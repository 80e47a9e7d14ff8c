/// @file TigerCases.cc
/// Enumeration over lattices, axes, ends, labels and directions; then one of each kind.
#include "TigerCases.h"

#include <algorithm>
#include <map>

namespace vdbtet::proof {

namespace {

using bcc::kOctahedra;
using bcc::kSliceTets;

Configuration octahedronOf(int lattice, int axis) {
    Configuration sites;
    for (const bcc::Vertex& vertex : kOctahedra[lattice][axis]) sites.push_back(siteOf(vertex));
    return sites;
}

template <typename Visit>
void forEachOctahedron(Visit&& visit) {
    for (int lattice = 0; lattice < 2; ++lattice) {
        for (int axis = 0; axis < 3; ++axis) visit(octahedronOf(lattice, axis));
    }
}

/// Call @a visit with all directions of the manifold sites that the labelling allows.
template <typename Visit>
void forEachMove(Configuration configuration, Visit&& visit) {
    std::vector<Site*> manifold;
    for (Site& site : configuration) {
        if (site.label == Label::Manifold) manifold.push_back(&site);
    }
    for (int directions = 0; directions < 1 << (3 * manifold.size()); ++directions) {
        for (std::size_t i = 0; i < manifold.size(); ++i) manifold[i]->direction = directions >> (3 * i) & 7;
        if (allowed(configuration)) visit(configuration);
    }
}

/// Configurations, those alike once.
class Kinds {
public:
    void add(const Configuration& configuration) {
        const auto [entry, isNew] = mNumbers.try_emplace(keyOf(configuration), mKinds.size());
        if (isNew) mKinds.push_back({configuration, 0});
        ++mKinds[entry->second].count;
    }
    std::vector<Counted> take() { return std::move(mKinds); }

private:
    std::map<Key, std::size_t> mNumbers;
    std::vector<Counted> mKinds;
};

template <typename Numbers>
Configuration part(const Configuration& sites, const Numbers& numbers) {
    Configuration some;
    for (int n : numbers) some.push_back(sites[n]);
    return some;
}

} // namespace

std::vector<Counted> movedTets() {
    Kinds kinds;
    forEachOctahedron([&](const Configuration& octahedron) {
        for (const auto& numbers : kSliceTets[bcc::S]) {
            for (int labels = 1; labels < 15; ++labels) {
                Configuration tet = part(octahedron, numbers);
                for (int i = 0; i < 4; ++i) {
                    tet[i].label = (labels >> i & 1) ? Label::Manifold : Label::Inside;
                }
                forEachMove(tet, [&](const Configuration& moved) { kinds.add(moved); });
            }
        }
    });
    return kinds.take();
}

std::vector<Counted> activeOctahedra() {
    Kinds kinds;
    forEachOctahedron([&](Configuration octahedron) {
        for (int i = 2; i < 6; ++i) octahedron[i].label = Label::Manifold;
        for (int outside : {0, 1}) {
            octahedron[outside].label = Label::Outside;
            octahedron[1 - outside].label = Label::Inside;
            forEachMove(octahedron, [&](const Configuration& moved) { kinds.add(moved); });
        }
    });
    return kinds.take();
}

Configuration Figure::worstTet() const {
    for (const auto& numbers : kSliceTets[bcc::S]) {
        const auto has = [&](int n) { return std::count(numbers, numbers + 4, number[n - 1]) > 0; };
        if (has(1) && has(2) && has(3) && has(4)) return part(octahedron, numbers);
    }
    return {};
}

std::vector<Figure> figures() {
    std::vector<Figure> all;
    forEachOctahedron([&](const Configuration& still) {
        for (int end : {0, 1}) {
            for (int pair = 0; pair < 4; ++pair) {
                Figure figure{still, {1 - end, end}, bcc::S};
                for (int i = 0; i < 4; ++i) figure.number[2 + i] = 2 + (pair + i) % 4;
                const auto move = [&](int n, int from) {
                    Site& site = figure.octahedron[figure.number[n - 1]];
                    site.label = Label::Manifold;
                    site.direction = directionBetween(figure.v(from), figure.v(2));
                };
                for (int from : {5, 6}) {
                    move(3, 4);
                    move(4, 3);
                    move(2, from);
                    // All tets of a slice hold the ends of its new edge.
                    const auto& tets = kSliceTets[bcc::SliceA];
                    const bool inA = std::all_of(tets, tets + 4, [&](const auto& tet) {
                        return std::count(tet, tet + 4, figure.number[from - 1]) > 0;
                    });
                    figure.slice = inA ? bcc::SliceA : bcc::SliceB;
                    if (allowed(figure.octahedron)) all.push_back(figure);
                }
            }
        }
    });
    return all;
}

} // namespace vdbtet::proof
