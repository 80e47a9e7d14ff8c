/// @file Fixtures.h
/// Level sets, fog volumes and hostile grids made by code, the same on every machine.
#pragma once

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdbtet::test {

using openvdb::Vec3d;

/// A deterministic generator (splitmix64): the standard distributions differ from library to library.
class Random {
public:
    explicit Random(std::uint64_t seed) : mState(seed) {}
    std::uint64_t next();
    double uniform(double lo, double hi);
    Vec3d inBox(double lo, double hi);

private:
    std::uint64_t mState;
};

/// A solid in world space: distance < 0 inside, and boxes that hold all of it.
struct Shape {
    std::function<double(const Vec3d&)> distance;
    std::vector<openvdb::BBoxd> bounds;
};

Shape sphere(const Vec3d& centre, double radius);
/// The torus of the paper's Table 1: radii 0.2 and 0.08, turned by 25 degrees about x, centred at 0.5.
Shape paperTorus();
Shape torus(const Vec3d& centre, double radius, double tube);
Shape box(const Vec3d& lo, const Vec3d& hi);
/// A gyroid's wall of the given thickness, clipped by a ball.
Shape gyroidBall(const Vec3d& centre, double radius, double period, double thickness);
/// Two balls of one radius whose centres are @a apart from each other along x.
Shape twoBalls(const Vec3d& centre, double radius, double apart);
/// A square plate normal to z.
Shape sheet(const Vec3d& centre, double halfSide, double thickness);
/// A ball eaten by smooth noise whose features are about @a feature long.
Shape noiseBall(std::uint64_t seed, const Vec3d& centre, double radius, double feature);

openvdb::math::Transform::Ptr uniformTransform(double voxel, const Vec3d& offset = Vec3d(0.0));
/// Index axes along the three vectors, in world units.
openvdb::math::Transform::Ptr affineTransform(const Vec3d& x, const Vec3d& y, const Vec3d& z,
                                              const Vec3d& offset = Vec3d(0.0));
openvdb::math::Transform::Ptr rotatedTransform(double voxel);
openvdb::math::Transform::Ptr shearedTransform(double voxel);
openvdb::math::Transform::Ptr mirroredTransform(double voxel);
openvdb::math::Transform::Ptr nonuniformTransform(const Vec3d& voxel);

/// A narrow-band level set, flood filled and pruned. The half width is in voxels of the shortest edge.
openvdb::FloatGrid::Ptr levelSet(const Shape& shape, const openvdb::math::Transform::Ptr& transform,
                                 double halfWidth = 3.0);
openvdb::FloatGrid::Ptr levelSet(const Shape& shape, double voxel = 1.0, double halfWidth = 3.0);
/// A density: 1 inside, 0 outside, 0.5 on the surface and linear over @a ramp voxels on either side of it.
openvdb::FloatGrid::Ptr fogVolume(const Shape& shape, const openvdb::math::Transform::Ptr& transform,
                                  double ramp = 2.0);

/// A grid without class whose voxels [0,n)^3 are a random value of random sign; background +1.
openvdb::FloatGrid::Ptr randomSigns(int n, std::uint64_t seed);
/// Random cuts with one root on every short edge of the lattice of two voxels, so that any root finder
/// finds the same. The lattice vertices in [0,2n]^3 are random; that share of them is inside.
openvdb::FloatGrid::Ptr randomCuts(int n, std::uint64_t seed, double insideShare = 0.5);
/// Random signs at the vertices of the lattice of two voxels, in [0,2n]^3, and cut points as near to the
/// middle of short edges as a thousandth; but vertices of the short share have theirs at 0.28.
openvdb::FloatGrid::Ptr middleCuts(int n, std::uint64_t seed, double insideShare, double shortShare = 0.0);
/// A level set made of constant tiles alone: the nodes of the given edge (8 or 128 voxels) at @a tiles.
openvdb::FloatGrid::Ptr constantTiles(int edge, const std::vector<openvdb::Coord>& tiles, bool active);

/// The same values at other index coordinates: each voxel and tile goes from ijk to move(ijk).
openvdb::FloatGrid::Ptr shifted(const openvdb::FloatGrid& grid, const openvdb::Coord& by);
/// Index axes permuted cyclically (x takes the place of y) and then mirrored where mirror[axis] is set.
openvdb::FloatGrid::Ptr turned(const openvdb::FloatGrid& grid, bool cycle, const std::array<bool, 3>& mirror);

/// A level set turned inside out.
openvdb::FloatGrid::Ptr negated(const openvdb::FloatGrid& levelSet);

/// The shortest edge of a voxel, world units.
double voxelEdge(const openvdb::math::Transform& transform);

} // namespace vdbtet::test
