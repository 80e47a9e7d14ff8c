// Builds each fixture voxel by voxel from a distance function.
#include "support/Fixtures.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

namespace vdbtet::test {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::math::Transform;

namespace {

constexpr double kPi = 3.14159265358979323846;

BBoxd cube(const Vec3d& centre, double half) { return {centre - Vec3d(half), centre + Vec3d(half)}; }

/// The voxels whose centres may lie in a world box, and one more all round.
CoordBBox voxelsOf(const BBoxd& bounds, const Transform& transform) {
    CoordBBox result = transform.worldToIndexNodeCentered(bounds);
    result.expand(1);
    return result;
}

template <typename Visit>
void forEachVoxel(const CoordBBox& box, const Visit& visit) {
    for (int x = box.min().x(); x <= box.max().x(); ++x)
        for (int y = box.min().y(); y <= box.max().y(); ++y)
            for (int z = box.min().z(); z <= box.max().z(); ++z) visit(Coord(x, y, z));
}

} // namespace

std::uint64_t Random::next() {
    std::uint64_t z = (mState += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

double Random::uniform(double lo, double hi) { return lo + (hi - lo) * (double(next() >> 11) * 0x1.0p-53); }

Vec3d Random::inBox(double lo, double hi) {
    const double x = uniform(lo, hi), y = uniform(lo, hi), z = uniform(lo, hi);
    return {x, y, z};
}

Shape sphere(const Vec3d& centre, double radius) {
    return {[=](const Vec3d& p) { return (p - centre).length() - radius; }, {cube(centre, radius)}};
}

Shape torus(const Vec3d& centre, double radius, double tube) {
    const auto distance = [=](const Vec3d& p) {
        const Vec3d q = p - centre;
        return std::hypot(std::hypot(q.x(), q.y()) - radius, q.z()) - tube;
    };
    return {distance, {cube(centre, radius + tube)}};
}

Shape paperTorus() {
    const Shape flat = torus(Vec3d(0.0), 0.2, 0.08);
    const double c = std::cos(25 * kPi / 180), s = std::sin(25 * kPi / 180);
    const auto distance = [=](const Vec3d& p) {
        const Vec3d q = p - Vec3d(0.5);
        return flat.distance(Vec3d(q.x(), c * q.y() + s * q.z(), c * q.z() - s * q.y()));
    };
    return {distance, {cube(Vec3d(0.5), 0.28)}};
}

Shape box(const Vec3d& lo, const Vec3d& hi) {
    const auto distance = [=](const Vec3d& p) {
        const Vec3d out = openvdb::math::maxComponent(lo - p, p - hi);
        const double outside = openvdb::math::maxComponent(out, Vec3d(0.0)).length();
        return outside + std::min(0.0, std::max({out.x(), out.y(), out.z()}));
    };
    return {distance, {BBoxd(lo, hi)}};
}

Shape gyroidBall(const Vec3d& centre, double radius, double period, double thickness) {
    const double k = 2 * kPi / period;
    const auto distance = [=](const Vec3d& p) {
        const Vec3d q = k * p;
        const double gyroid = std::sin(q.x()) * std::cos(q.y()) + std::sin(q.y()) * std::cos(q.z()) +
                              std::sin(q.z()) * std::cos(q.x());
        // The gyroid's gradient is about 1.5 k on its surface.
        const double wall = std::abs(gyroid) / (1.5 * k) - 0.5 * thickness;
        return std::max(wall, (p - centre).length() - radius);
    };
    return {distance, {cube(centre, radius)}};
}

Shape twoBalls(const Vec3d& centre, double radius, double apart) {
    const Vec3d half(0.5 * apart, 0, 0);
    const auto distance = [=](const Vec3d& p) {
        return std::min((p - centre - half).length(), (p - centre + half).length()) - radius;
    };
    return {distance, {cube(centre - half, radius), cube(centre + half, radius)}};
}

Shape sheet(const Vec3d& centre, double halfSide, double thickness) {
    const Vec3d half(halfSide, halfSide, 0.5 * thickness);
    return box(centre - half, centre + half);
}

Shape noiseBall(std::uint64_t seed, const Vec3d& centre, double radius, double feature) {
    struct Wave {
        Vec3d k;
        double phase;
    };
    Random random(seed);
    std::vector<Wave> waves(24);
    for (Wave& wave : waves) {
        const Vec3d direction = random.inBox(-1, 1).unitSafe();
        wave.k = direction * (kPi / feature * random.uniform(0.7, 1.3));
        wave.phase = random.uniform(0, 2 * kPi);
    }
    const auto distance = [=](const Vec3d& p) {
        double noise = 0;
        for (const Wave& wave : waves) noise += std::cos(wave.k.dot(p) + wave.phase);
        // A sum of n cosines has the spread sqrt(n/2), and a gradient about pi/feature times that.
        noise *= feature / (kPi * std::sqrt(0.5 * double(waves.size())));
        return std::max(noise, (p - centre).length() - radius);
    };
    return {distance, {cube(centre, radius)}};
}

Transform::Ptr uniformTransform(double voxel, const Vec3d& offset) {
    auto result = Transform::createLinearTransform(voxel);
    if (!offset.isZero()) result->postTranslate(offset);
    return result;
}

Transform::Ptr affineTransform(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& offset) {
    // OpenVDB multiplies row vectors from the left, so that the images of the axes are the rows.
    return Transform::createLinearTransform(openvdb::Mat4d(x[0], x[1], x[2], 0.0, y[0], y[1], y[2], 0.0, z[0],
                                                           z[1], z[2], 0.0, offset[0], offset[1], offset[2],
                                                           1.0));
}

Transform::Ptr rotatedTransform(double voxel) {
    auto result = Transform::createLinearTransform(voxel);
    result->postRotate(0.6, openvdb::math::X_AXIS);
    result->postRotate(-0.35, openvdb::math::Y_AXIS);
    result->postRotate(1.1, openvdb::math::Z_AXIS);
    result->postTranslate(voxel * Vec3d(0.31, -1.7, 4.13));
    return result;
}

Transform::Ptr shearedTransform(double voxel) {
    return affineTransform(voxel * Vec3d(0.9, 0.2, -0.1), voxel * Vec3d(-0.15, 1.1, 0.25),
                           voxel * Vec3d(0.3, -0.05, 0.95), voxel * Vec3d(2.2, 0.7, -0.4));
}

Transform::Ptr mirroredTransform(double voxel) {
    return affineTransform({-voxel, 0, 0}, {0, voxel, 0}, {0, 0, voxel});
}

Transform::Ptr nonuniformTransform(const Vec3d& voxel) {
    return affineTransform({voxel[0], 0, 0}, {0, voxel[1], 0}, {0, 0, voxel[2]});
}

double voxelEdge(const Transform& transform) {
    const Vec3d origin = transform.indexToWorld(Vec3d(0.0));
    double shortest = (transform.indexToWorld(Vec3d(1, 0, 0)) - origin).length();
    shortest = std::min(shortest, (transform.indexToWorld(Vec3d(0, 1, 0)) - origin).length());
    return std::min(shortest, (transform.indexToWorld(Vec3d(0, 0, 1)) - origin).length());
}

FloatGrid::Ptr levelSet(const Shape& shape, const Transform::Ptr& transform, double halfWidth) {
    const double background = halfWidth * voxelEdge(*transform);
    auto grid = FloatGrid::create(float(background));
    grid->setTransform(transform);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName("fixture");
    auto accessor = grid->getAccessor();
    for (BBoxd bounds : shape.bounds) {
        bounds.expand(background);
        forEachVoxel(voxelsOf(bounds, *transform), [&](const Coord& ijk) {
            const double d = shape.distance(transform->indexToWorld(ijk));
            if (std::abs(d) < background) {
                accessor.setValue(ijk, float(d));
            } else if (d < 0) {
                accessor.setValueOff(ijk, float(-background));
            }
        });
    }
    openvdb::tools::signedFloodFill(grid->tree());
    openvdb::tools::pruneLevelSet(grid->tree());
    return grid;
}

FloatGrid::Ptr levelSet(const Shape& shape, double voxel, double halfWidth) {
    return levelSet(shape, uniformTransform(voxel), halfWidth);
}

FloatGrid::Ptr fogVolume(const Shape& shape, const Transform::Ptr& transform, double ramp) {
    auto grid = FloatGrid::create(0.0f);
    grid->setTransform(transform);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName("fixture");
    auto accessor = grid->getAccessor();
    const double width = ramp * voxelEdge(*transform);
    for (BBoxd bounds : shape.bounds) {
        bounds.expand(width);
        forEachVoxel(voxelsOf(bounds, *transform), [&](const Coord& ijk) {
            const double d = shape.distance(transform->indexToWorld(ijk));
            const double density = std::clamp(0.5 - 0.5 * d / width, 0.0, 1.0);
            if (density > 0) accessor.setValue(ijk, float(density));
        });
    }
    openvdb::tools::prune(grid->tree());
    return grid;
}

FloatGrid::Ptr randomSigns(int n, std::uint64_t seed) {
    auto grid = FloatGrid::create(1.0f);
    auto accessor = grid->getAccessor();
    Random random(seed);
    forEachVoxel(CoordBBox::createCube(Coord(0), n), [&](const Coord& ijk) {
        const double size = random.uniform(0.05, 1);
        accessor.setValue(ijk, float(random.next() & 1 ? size : -size));
    });
    return grid;
}

FloatGrid::Ptr randomCuts(int n, std::uint64_t seed, double insideShare) {
    auto grid = FloatGrid::create(1.0f);
    auto accessor = grid->getAccessor();
    Random random(seed);
    // Along a short edge, the diagonal of a voxel cell, the trilinear interpolant is the cubic of Bernstein
    // coefficients (vertex, mean of the voxels with one odd coordinate, mean of those with two, vertex).
    // Zeros for the third leave one change of sign, hence one root, whatever the others are.
    const CoordBBox block(Coord(0), Coord(2 * n));
    forEachVoxel(CoordBBox(Coord(-3), Coord(2 * n + 3)), [&](const Coord& ijk) {
        const int odd = (ijk.x() & 1) + (ijk.y() & 1) + (ijk.z() & 1);
        const double size = random.uniform(0.05, 1);
        const double value = odd == 2 ? 0 : random.uniform(0, 1) < insideShare ? -size : size;
        const bool vertex = odd == 0 || odd == 3;
        accessor.setValue(ijk, float(vertex && !block.isInside(ijk) ? 1.0 : value));
    });
    return grid;
}

FloatGrid::Ptr middleCuts(int n, std::uint64_t seed, double insideShare, double shortShare) {
    auto grid = FloatGrid::create(1.0f);
    auto accessor = grid->getAccessor();
    Random random(seed);
    // With zeros between the ends the interpolant is (1-t)^3 a + t^3 b: the root is where linear
    // interpolation between the cube roots of a and b has it.
    const CoordBBox block(Coord(0), Coord(2 * n));
    forEachVoxel(CoordBBox(Coord(-3), Coord(2 * n + 3)), [&](const Coord& ijk) {
        const int odd = (ijk.x() & 1) + (ijk.y() & 1) + (ijk.z() & 1);
        const double size = random.uniform(0.997, 1.003) * (random.uniform(0, 1) < shortShare ? 0.06 : 1.0);
        const bool inside = random.uniform(0, 1) < insideShare && block.isInside(ijk);
        accessor.setValue(ijk, float(odd == 1 || odd == 2 ? 0.0 : inside ? -size : size));
    });
    return grid;
}

FloatGrid::Ptr constantTiles(int edge, const std::vector<Coord>& tiles, bool active) {
    auto grid = FloatGrid::create(3.0f);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::Index level = edge == 8 ? 1 : 2;
    for (const Coord& tile : tiles) grid->tree().addTile(level, tile, -3.0f, active);
    return grid;
}

namespace {

/// Copies leaves and tiles by their corner voxels, so that a tile stays a tile where it can.
template <typename Move>
FloatGrid::Ptr moved(const FloatGrid& grid, const Move& move) {
    auto result = FloatGrid::create(grid.background());
    result->setTransform(grid.transform().copy());
    result->setGridClass(grid.getGridClass());
    auto accessor = result->getAccessor();
    for (auto it = grid.cbeginValueAll(); it; ++it) {
        if (it.isVoxelValue()) {
            const Coord ijk = move(it.getCoord());
            accessor.setValue(ijk, *it);
            if (!it.isValueOn()) accessor.setValueOff(ijk);
            continue;
        }
        if (*it == grid.background() && !it.isValueOn()) continue;
        CoordBBox box;
        it.getBoundingBox(box);
        const Coord a = move(box.min()), b = move(box.max());
        result->fill(CoordBBox(Coord::minComponent(a, b), Coord::maxComponent(a, b)), *it, it.isValueOn());
    }
    openvdb::tools::prune(result->tree());
    return result;
}

} // namespace

FloatGrid::Ptr shifted(const FloatGrid& grid, const Coord& by) {
    return moved(grid, [&](const Coord& ijk) { return ijk + by; });
}

FloatGrid::Ptr turned(const FloatGrid& grid, bool cycle, const std::array<bool, 3>& mirror) {
    return moved(grid, [&](const Coord& ijk) {
        const Coord p = cycle ? Coord(ijk.z(), ijk.x(), ijk.y()) : ijk;
        return Coord(mirror[0] ? -p.x() : p.x(), mirror[1] ? -p.y() : p.y(), mirror[2] ? -p.z() : p.z());
    });
}

FloatGrid::Ptr negated(const FloatGrid& levelSet) {
    const auto result = levelSet.deepCopy();
    for (auto it = result->beginValueOn(); it; ++it) it.setValue(-*it);
    // This also turns the inactive values, which are the background's or its negative.
    openvdb::tools::changeBackground(result->tree(), -levelSet.background());
    return result;
}

} // namespace vdbtet::test
