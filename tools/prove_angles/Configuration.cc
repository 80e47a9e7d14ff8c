/// @file Configuration.cc
/// Signs by trial, symmetries by their 48 matrices.
#include "Configuration.h"

#include <algorithm>

namespace vdbtet::proof {

namespace {

using Place = std::array<int, 3>;

/// A vertex that is not manifold, and its sign.
struct Settled {
    Place at;
    bool inside;
};

bool joinedByShortEdge(const Place& a, const Place& b) {
    return std::abs(a[0] - b[0]) == 1 && std::abs(a[1] - b[1]) == 1 && std::abs(a[2] - b[2]) == 1;
}

Place targetOf(const Site& site) {
    Place target = site.at;
    for (int axis = 0; axis < 3; ++axis) target[axis] += bcc::sign(site.direction, axis);
    return target;
}

bool consistent(const std::vector<Settled>& settled) {
    for (std::size_t i = 0; i < settled.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Settled &a = settled[i], &b = settled[j];
            if (a.inside != b.inside && (a.at == b.at || joinedByShortEdge(a.at, b.at))) return false;
        }
    }
    return true;
}

/// One of the 48 symmetries: component i of the image is sign[i] times component from[i].
struct Symmetry {
    Place from, sign;

    Place operator()(const Place& p) const {
        return {sign[0] * p[from[0]], sign[1] * p[from[1]], sign[2] * p[from[2]]};
    }
    int operator()(int direction) const {
        const Place image =
            (*this)(Place{bcc::sign(direction, 0), bcc::sign(direction, 1), bcc::sign(direction, 2)});
        return 4 * (image[0] > 0) + 2 * (image[1] > 0) + (image[2] > 0);
    }
};

std::vector<Symmetry> allSymmetries() {
    std::vector<Symmetry> all;
    Place from{0, 1, 2};
    do {
        for (int d = 0; d < bcc::kDirections; ++d) {
            all.push_back({from, {bcc::sign(d, 0), bcc::sign(d, 1), bcc::sign(d, 2)}});
        }
    } while (std::next_permutation(from.begin(), from.end()));
    return all;
}

} // namespace

Site siteOf(const bcc::Vertex& v) {
    return {{2 * v.x + v.lattice, 2 * v.y + v.lattice, 2 * v.z + v.lattice}};
}

int directionBetween(const Site& from, const Site& to) {
    if (!joinedByShortEdge(from.at, to.at)) return -1;
    return 4 * (to.at[0] > from.at[0]) + 2 * (to.at[1] > from.at[1]) + (to.at[2] > from.at[2]);
}

std::string describe(const Configuration& sites) {
    std::string text;
    for (const Site& site : sites) {
        if (!text.empty()) text += "  ";
        text += '(';
        for (int axis = 0; axis < 3; ++axis) {
            const int whole = site.at[axis] / 2, half = site.at[axis] % 2;
            text += (axis > 0 ? "," : "") + std::string(site.at[axis] < 0 ? "-" : "") +
                    std::to_string(std::abs(whole)) + (half != 0 ? ".5" : "");
        }
        text += ')';
        if (site.direction >= 0) {
            text += "->";
            for (int axis = 0; axis < 3; ++axis) text += bcc::sign(site.direction, axis) > 0 ? '+' : '-';
        } else {
            text += site.label == Label::Inside ? " in" : site.label == Label::Outside ? " out" : " moved";
        }
    }
    return text;
}

bool allowed(const Configuration& configuration) {
    std::vector<Settled> known;
    std::vector<Place> targets;
    for (const Site& site : configuration) {
        if (site.label != Label::Manifold) {
            known.push_back({site.at, site.label == Label::Inside});
            continue;
        }
        targets.push_back(targetOf(site));
        for (const Site& other : configuration) {
            if (other.label == Label::Manifold && other.at == targets.back()) return false;
        }
    }
    for (int signs = 0; signs < 1 << targets.size(); ++signs) {
        std::vector<Settled> settled = known;
        for (std::size_t i = 0; i < targets.size(); ++i) {
            settled.push_back({targets[i], (signs >> i & 1) != 0});
        }
        if (consistent(settled)) return true;
    }
    return false;
}

Key keyOf(const Configuration& configuration) {
    static const std::vector<Symmetry> kSymmetries = allSymmetries();
    const int count = int(configuration.size());
    Place sum{};
    for (const Site& site : configuration) {
        for (int axis = 0; axis < 3; ++axis) sum[axis] += site.at[axis];
    }
    Key least, key(configuration.size());
    for (const Symmetry& symmetry : kSymmetries) {
        for (int i = 0; i < count; ++i) {
            const Site& site = configuration[i];
            Place fromCentre;
            for (int axis = 0; axis < 3; ++axis) fromCentre[axis] = count * site.at[axis] - sum[axis];
            const Place image = symmetry(fromCentre);
            const int direction = site.direction < 0 ? bcc::kDirections : symmetry(site.direction);
            key[i] = std::uint32_t(image[0] + 64) << 20 | std::uint32_t(image[1] + 64) << 13 |
                     std::uint32_t(image[2] + 64) << 6 | std::uint32_t(site.label) << 4 |
                     std::uint32_t(direction);
        }
        std::sort(key.begin(), key.end());
        if (least.empty() || key < least) least = key;
    }
    return least;
}

} // namespace vdbtet::proof
