/// @file PlaneProblems.cc
/// Orientations and labels; which planes give those labels are linear conditions.
#include "PlaneProblems.h"

#include "Configuration.h"

#include <algorithm>
#include <set>

namespace vdbtet::proof {

namespace {

/// Sites by their places relative to the first one.
class PlaneProblem {
public:
    PlaneProblem(const Configuration& sites, double tau) : mSites(sites), mTau(enclose(tau)) {
        mProblem.domain = {Interval(0.0, 1.0), Interval(0.0, 1.0), Interval(-4.0, 4.0), Interval(0.0)};
        mProblem.conditions.push_back({0.0, {1.0, -1.0, 0.0, 0.0}});
        mProblem.name = describe(sites);
        for (const Site& site : sites) restrict(site);
    }

    /// @param numbers  of sites
    Tet tetOf(const int (&numbers)[4]) const {
        Tet tet;
        for (int i = 0; i < 4; ++i) {
            const Site& site = mSites[numbers[i]];
            tet[i].kind = Corner::Plane;
            tet[i].parameter = site.label == Label::Manifold;
            tet[i].home = home(site);
        }
        return tet;
    }

    Problem take(std::vector<std::vector<Tet>> alternatives) {
        mProblem.alternatives = std::move(alternatives);
        return std::move(mProblem);
    }

private:
    std::array<double, 3> home(const Site& site) const {
        std::array<double, 3> place;
        for (int axis = 0; axis < 3; ++axis) place[axis] = 0.5 * (site.at[axis] - mSites[0].at[axis]);
        return place;
    }

    /// Require that sign (height - fraction m) >= 0.
    void require(const Site& site, double sign, const Interval& fraction) {
        const std::array<double, 3> at = home(site);
        const Interval half = fraction * 0.5;
        mProblem.conditions.push_back(
            {(at[0] - half) * sign, {(at[1] - half) * sign, (at[2] - half) * sign, Interval(sign), 0.0}});
    }

    void restrict(const Site& site) {
        if (site.label == Label::Inside) require(site, -1.0, -mTau);
        if (site.label == Label::Outside) require(site, 1.0, 1.0 - mTau);
        if (site.label != Label::Manifold) return;
        require(site, 1.0, -mTau);
        require(site, -1.0, 1.0 - mTau);
    }

    const Configuration mSites;
    const Interval mTau;
    Problem mProblem;
};

/// All octahedra of the tables, those that differ by a translation once.
std::vector<Configuration> orientations() {
    std::vector<Configuration> all;
    std::set<std::array<int, 3>> spines;
    for (const auto& lattice : bcc::kOctahedra) {
        for (const bcc::Octahedron& octahedron : lattice) {
            Configuration sites;
            for (const bcc::Vertex& vertex : octahedron) sites.push_back(siteOf(vertex));
            std::array<int, 3> spine;
            for (int axis = 0; axis < 3; ++axis) spine[axis] = sites[1].at[axis] - sites[0].at[axis];
            if (spines.insert(spine).second) all.push_back(sites);
        }
    }
    return all;
}

/// Whether a steepest short edge joins two manifold vertices. It cannot: their heights would differ by m, and
/// are strictly between two that do.
bool anySteepestEdge(const Configuration& sites) {
    for (const Site& from : sites) {
        for (const Site& to : sites) {
            const bool both = from.label == Label::Manifold && to.label == Label::Manifold;
            if (both && directionBetween(from, to) == bcc::kDirections - 1) return true;
        }
    }
    return false;
}

} // namespace

std::vector<Problem> planeTetProblems(double tau) {
    std::vector<Problem> problems;
    for (const Configuration& octahedron : orientations()) {
        for (const auto& numbers : bcc::kSliceTets[bcc::S]) {
            for (int labels = 1; labels < 15; ++labels) {
                Configuration tet;
                for (int i = 0; i < 4; ++i) {
                    tet.push_back(octahedron[numbers[i]]);
                    tet[i].label = (labels >> i & 1) ? Label::Manifold : Label::Inside;
                }
                if (anySteepestEdge(tet)) continue;
                PlaneProblem problem(tet, tau);
                problems.push_back(problem.take({{problem.tetOf({0, 1, 2, 3})}}));
            }
        }
    }
    return problems;
}

std::vector<Problem> planeOctahedronProblems(double tau) {
    std::vector<Problem> problems;
    for (Configuration octahedron : orientations()) {
        for (int i = 2; i < 6; ++i) octahedron[i].label = Label::Manifold;
        for (int inside : {0, 1}) {
            octahedron[inside].label = Label::Inside;
            octahedron[1 - inside].label = Label::Outside;
            PlaneProblem problem(octahedron, tau);
            std::vector<std::vector<Tet>> slices;
            for (bcc::Slice slice : {bcc::SliceA, bcc::SliceB}) {
                slices.emplace_back();
                for (const auto& numbers : bcc::kSliceTets[slice]) {
                    if (std::count(numbers, numbers + 4, inside) > 0)
                        slices.back().push_back(problem.tetOf(numbers));
                }
            }
            problems.push_back(problem.take(std::move(slices)));
            problems.back().policy = Policy::Quality;
        }
    }
    return problems;
}

} // namespace vdbtet::proof
