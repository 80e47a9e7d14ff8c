/// @file Shapes.h
/// Tets whose vertices depend on parameters, and what is proved of them; for doubles, intervals and jets
/// alike.
#pragma once

#include "Jet.h"

#include "bcc/Lattice.h"

#include <array>
#include <cmath>

namespace vdbtet::proof {

template <typename T>
using Values = std::array<T, kParameters>;

/// A box of parameters.
using Box = Values<Interval>;
using Point = Values<double>;

inline Values<Jet> jetsOf(const Box& box) {
    Values<Jet> jets;
    for (int p = 0; p < kParameters; ++p) jets[p] = Jet::parameter(p, box[p]);
    return jets;
}

template <typename T>
struct Vec {
    T x, y, z;
};
template <typename T>
Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T dot(const Vec<T>& a, const Vec<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
T squaredLength(const Vec<T>& a) {
    return square(a.x) + square(a.y) + square(a.z);
}

/// A corner of a tet: a vertex of the lattice, in units of the spacing, and how it moves.
struct Corner {
    enum Kind {
        Still,
        Along, ///< by parameter number @a parameter times @a edge
        Plane  ///< in a problem of planes: onto the plane if @a parameter is 1
    };
    Kind kind = Still;
    std::array<double, 3> home{};
    std::array<double, 3> edge{};
    int parameter = 0;

    /// @brief The place for the parameters @a p.
    /// @details Of planes the parameters are u, v and h: (1,u,v) is normal to the plane, and (1,u,v).x + h
    /// is 0 on it. Their tets are multiplied by 1 + u² + v², which turns no angle and takes no division.
    template <typename T>
    Vec<T> at(const Values<T>& p) const {
        if (kind == Still) return {T(home[0]), T(home[1]), T(home[2])};
        if (kind == Along) {
            const T& a = p[parameter];
            return {a * edge[0] + T(home[0]), a * edge[1] + T(home[1]), a * edge[2] + T(home[2])};
        }
        const T scale = square(p[0]) + square(p[1]) + T(1.0);
        Vec<T> place{scale * home[0], scale * home[1], scale * home[2]};
        if (parameter == 0) return place;
        const T height = p[0] * home[1] + p[1] * home[2] + p[2] + T(home[0]);
        return place - Vec<T>{height, height * p[0], height * p[1]};
    }
};

using Tet = std::array<Corner, 4>;

template <typename T>
using Corners = std::array<Vec<T>, 4>;

template <typename T>
Corners<T> cornersOf(const Tet& tet, const Values<T>& p) {
    return {tet[0].at(p), tet[1].at(p), tet[2].at(p), tet[3].at(p)};
}

/// The outward normal of the face opposite to a corner.
template <typename T>
Vec<T> normal(const Corners<T>& c, int face) {
    const auto& f = bcc::kTetFaces[face];
    return cross(c[f[1]] - c[f[0]], c[f[2]] - c[f[0]]);
}

/// The faces that meet at each of the six edges.
constexpr int kEdgeFaces[6][2] = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};

/// The cosine of the dihedral angle between two faces (paper, equation (16)).
template <typename T>
T cosineBetween(const Vec<T>& n, const Vec<T>& m) {
    return -(dot(n, m) / sqrt(squaredLength(n) * squaredLength(m)));
}

/// Six times the volume.
template <typename T>
T volume6(const Corners<T>& c) {
    return dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]);
}

/// The squared radius of the sphere through the corners.
template <typename T>
T squaredRadius(const Corners<T>& c) {
    const Vec<T> a = c[1] - c[0], b = c[2] - c[0], d = c[3] - c[0];
    const T aa = squaredLength(a), bb = squaredLength(b), dd = squaredLength(d);
    const Vec<T> bd = cross(b, d), da = cross(d, a), ab = cross(a, b);
    const Vec<T> centre{aa * bd.x + bb * da.x + dd * ab.x, aa * bd.y + bb * da.y + dd * ab.y,
                        aa * bd.z + bb * da.z + dd * ab.z};
    return squaredLength(centre) / (square(dot(a, bd)) * 4.0);
}

} // namespace vdbtet::proof
