/// @file fuzz_mesh.cc
/// Bytes are options, a transform and voxels; whatever they are, the mesh is valid, or there is an exception
/// of this library.
#include "fuzz/MeshFault.h"

#include <vdbtet/Errors.h>
#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/openvdb.h>

#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace {

using namespace vdbtet;
using openvdb::Vec3d;

/// Takes one byte after another, and zeros at the end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : mNext(data), mEnd(data + size) {}
    unsigned next() { return mNext == mEnd ? 0 : *mNext++; }
    unsigned below(unsigned count) { return next() % count; }
    double between(double lo, double hi) { return lo + (hi - lo) * next() / 255.0; }
    bool done() const { return mNext == mEnd; }

private:
    const std::uint8_t *mNext, *mEnd;
};

/// Always as many bytes, so that a change of one option leaves all others as they are.
Options optionsFrom(Bytes& bytes) {
    constexpr double kVoxels[] = {1.0, 0.6, 1.37, 2.0, 3.0};
    constexpr double kTargets[] = {30.0, 35.0, 1.0, 38.0};
    Options options;
    options.voxels = kVoxels[bytes.below(5)];
    options.tiger = 1 + int(bytes.below(3));
    const double tau = bytes.between(0.5, 0.8);
    if (options.tiger == 3) options.tau = tau;
    options.boundary = Boundary(bytes.below(3));
    const unsigned inside = bytes.below(8), level = bytes.below(64), size = bytes.below(8);
    if (inside < 3) options.inside = Inside(inside);
    if (level < 32) options.isovalue = double(level) / 16.0 - 1.0;
    options.grade = size > 3;
    if (size > 5) options.maxSize = size == 6 ? 0.6 : 2.5;
    const unsigned target = bytes.below(8);
    if (target < 4) options.optimize = kTargets[target];
    options.sweeps = 2;
    options.maxSurfaceTiles = 600;
    return options;
}

openvdb::math::Transform::Ptr transformFrom(Bytes& bytes) {
    const unsigned kind = bytes.below(8);
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) matrix[i][k] = double(std::int8_t(bytes.next())) / 64.0;
    auto transform = openvdb::math::Transform::createLinearTransform(0.1);
    switch (kind) {
    case 1:
        transform->preScale(Vec3d(1.0, -1.0, 1.0));
        break;
    case 2:
        transform->preShear(0.4, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
        break;
    case 3:
        transform->postTranslate(Vec3d(1e4, -1e4, 1e4));
        break;
    case 4:
        transform->postTranslate(Vec3d(1e13)); // near the end of what double resolves
        break;
    case 5:
        transform->preScale(Vec3d(1.0, 3.0, 0.3));
        break;
    case 6:
        try {
            return openvdb::math::Transform::createLinearTransform(matrix);
        } catch (const openvdb::ArithmeticError&) { // OpenVDB has no singular ones
        }
        break;
    default:
        break;
    }
    return transform;
}

/// @brief One value a byte, in a box that straddles the borders of leaves.
/// @details Some bytes are no values: tiles, what is no number, and runs.
template <typename GridT>
typename GridT::Ptr gridFrom(Bytes& bytes) {
    constexpr int kDim = 12;
    using Value = typename GridT::ValueType;
    using Limits = std::numeric_limits<Value>;
    const auto grid = GridT::create(Value(std::int8_t(bytes.next())) / 16);
    grid->setTransform(transformFrom(bytes));
    grid->setGridClass(openvdb::GridClass(bytes.below(4)));
    constexpr openvdb::Int32 kPlaces[] = {-4, 1000000, 2147483647 - kDim}; // where coordinates end
    const unsigned place = bytes.below(8);
    const openvdb::Coord corner(kPlaces[place < 3 ? place : 0], -4, -4);
    auto accessor = grid->getAccessor();
    for (int n = 0; n < kDim * kDim * kDim && !bytes.done(); ++n) {
        const openvdb::Coord at = corner.offsetBy(n / (kDim * kDim), n / kDim % kDim, n % kDim);
        const auto byte = std::int8_t(bytes.next());
        if (byte == 127) {
            accessor.addTile(1 + bytes.below(2), at, Value(std::int8_t(bytes.next())) / 16, true);
        } else if (byte == 126) {
            accessor.setValue(at, bytes.below(2) ? Limits::quiet_NaN() : Limits::infinity());
        } else if (byte == 125) {
            n += int(bytes.next()); // the background
        } else {
            accessor.setValue(at, Value(byte) / 16);
        }
    }
    return grid;
}

void mesh(const openvdb::GridBase& grid, const Options& options) {
    TetMesh mesh;
    Report report;
    try {
        report = volumeToTets(grid, mesh, options);
    } catch (const Error&) {
        return;
    }
    const std::string fault = test::meshFault(mesh, report);
    if (fault.empty() && (options.boundary != Boundary::Manifold || report.boundary.left == 0)) return;
    std::fprintf(stderr, "the mesh has %s\n", fault.empty() ? "bad vertices left" : fault.c_str());
    std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    openvdb::initialize();
    Bytes bytes(data, size);
    const Options options = optionsFrom(bytes);
    if (bytes.below(2) == 0) {
        mesh(*gridFrom<openvdb::FloatGrid>(bytes), options);
    } else {
        mesh(*gridFrom<openvdb::DoubleGrid>(bytes), options);
    }
    return 0;
}
