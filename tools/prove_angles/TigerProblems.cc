/// @file TigerProblems.cc
/// Tets with parameters, in the place of sites.
#include "TigerProblems.h"

#include "TigerCases.h"

#include "flips/Flips.h"

#include <algorithm>
#include <set>

namespace vdbtet::proof {

namespace {

using bcc::kSliceTets;

/// The parameter of manifold site number @a site: they are in the order of the manifold sites.
int parameterOf(const Configuration& sites, int site) {
    int parameter = 0;
    for (int i = 0; i < site; ++i) parameter += sites[i].label == Label::Manifold;
    return parameter;
}

/// Corners of a tet with the parameters that they have among @a sites, by their numbers there.
template <typename Numbers>
Tet tetOf(const Configuration& sites, const Numbers& numbers) {
    Tet tet;
    for (int i = 0; i < 4; ++i) {
        const Site& site = sites[numbers[i]];
        Corner& corner = tet[i];
        for (int axis = 0; axis < 3; ++axis) corner.home[axis] = 0.5 * site.at[axis];
        if (site.label != Label::Manifold) continue;
        corner.kind = Corner::Along;
        corner.parameter = parameterOf(sites, numbers[i]);
        std::copy_n(bcc::kShortEdges[site.direction], 3, corner.edge.begin());
    }
    return tet;
}

constexpr int kAll[4] = {0, 1, 2, 3};

/// The problem whose parameters are the moves of the manifold sites, in their order.
Problem problemOf(const Configuration& sites, int count, const Interval& moves) {
    Problem problem;
    problem.name = describe(sites);
    problem.count = count;
    problem.domain.fill(0.0);
    int parameter = 0;
    for (const Site& site : sites) {
        if (site.label == Label::Manifold) problem.domain[parameter++] = moves;
    }
    return problem;
}

/// The tets of a slice that are in the mesh.
std::vector<Tet> sliceOf(const Configuration& octahedron, bcc::Slice slice) {
    std::vector<Tet> tets;
    for (const auto& numbers : kSliceTets[slice]) {
        const auto count = [&](Label label) {
            return std::count_if(numbers, numbers + 4, [&](int n) { return octahedron[n].label == label; });
        };
        if (count(Label::Outside) == 0 && count(Label::Inside) > 0) {
            tets.push_back(tetOf(octahedron, numbers));
        }
    }
    return tets;
}

const Interval kMoves(0.0, kLongestMove);
const Interval kFarMoves(enclose(kExtremeMove).lower(), kLongestMove);
const Interval kShortMoves(0.0, enclose(kExtremeMove).upper());

/// One figure of each kind of octahedron.
std::vector<Figure> distinctFigures() {
    std::vector<Figure> distinct;
    std::set<Key> known;
    for (const Figure& figure : figures()) {
        if (known.insert(keyOf(figure.octahedron)).second) distinct.push_back(figure);
    }
    return distinct;
}

/// Call @a visit(figure, octahedron) for each move of v5 or v6 in addition.
template <typename Visit>
void forEachFourth(Visit&& visit) {
    std::set<Key> known;
    for (const Figure& figure : figures()) {
        for (int fourth : {5, 6}) {
            Configuration octahedron = figure.octahedron;
            octahedron[figure.number[fourth - 1]].label = Label::Manifold;
            for (int d = 0; d < bcc::kDirections; ++d) {
                octahedron[figure.number[fourth - 1]].direction = d;
                if (allowed(octahedron) && known.insert(keyOf(octahedron)).second) {
                    visit(figure, fourth, octahedron);
                }
            }
        }
    }
}

} // namespace

std::vector<Problem> tetProblems(bool withFigures) {
    std::set<Key> left;
    if (!withFigures) {
        for (const Figure& figure : figures()) left.insert(keyOf(figure.worstTet()));
    }
    std::vector<Problem> problems;
    for (const auto& [tet, count] : movedTets()) {
        if (left.count(keyOf(tet))) continue;
        problems.push_back(problemOf(tet, count, kMoves));
        problems.back().alternatives = {{tetOf(tet, kAll)}};
    }
    return problems;
}

std::vector<Problem> activeProblems() {
    std::vector<Problem> problems;
    for (const auto& [octahedron, count] : activeOctahedra()) {
        problems.push_back(problemOf(octahedron, count, kMoves));
        problems.back().alternatives = {sliceOf(octahedron, bcc::SliceA), sliceOf(octahedron, bcc::SliceB)};
        problems.back().policy = Policy::Algorithm4;
    }
    return problems;
}

std::vector<Problem> flippedProblems(bool bestSlice) {
    std::vector<Problem> problems;
    for (const Figure& figure : distinctFigures()) {
        for (bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
            if (bestSlice && slice != figure.slice) continue;
            problems.push_back(problemOf(figure.octahedron, 1, kFarMoves));
            problems.back().alternatives = {sliceOf(figure.octahedron, slice)};
        }
    }
    return problems;
}

std::vector<Problem> shortMoveProblems() {
    std::vector<Problem> problems;
    for (const Figure& figure : distinctFigures()) {
        const Configuration tet = figure.worstTet();
        for (int shortOne = 0; shortOne < 3; ++shortOne) {
            problems.push_back(problemOf(tet, 1, kMoves));
            problems.back().domain[shortOne] = kShortMoves;
            problems.back().alternatives = {{tetOf(tet, kAll)}};
        }
    }
    return problems;
}

std::vector<Problem> sphereProblems() {
    std::vector<Problem> problems;
    forEachFourth([&](const Figure& figure, int fourth, const Configuration& octahedron) {
        problems.push_back(problemOf(octahedron, 1, kFarMoves));
        problems.back().domain[parameterOf(octahedron, figure.number[fourth - 1])] = kMoves;
        const std::array<int, 4> numbers{figure.number[1], figure.number[2], figure.number[3],
                                         figure.number[fourth - 1]};
        problems.back().alternatives = {{tetOf(octahedron, numbers)}};
    });
    return problems;
}

std::vector<Problem> lastResortProblems() {
    std::vector<Problem> problems;
    forEachFourth([&](const Figure& figure, int fourth, const Configuration& octahedron) {
        problems.push_back(problemOf(octahedron, 1, kFarMoves));
        problems.back().domain[parameterOf(octahedron, figure.number[fourth - 1])] = kShortMoves;
        for (bcc::Slice slice : {bcc::S, bcc::SliceA, bcc::SliceB}) {
            problems.back().alternatives.push_back(sliceOf(octahedron, slice));
        }
        problems.back().policy = Policy::Algorithm4;
    });
    return problems;
}

} // namespace vdbtet::proof
