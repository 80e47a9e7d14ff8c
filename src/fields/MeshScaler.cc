/// @file MeshScaler.cc
/// Copies of positions, times a factor.
#include <vdbtet/MeshScaler.h>

#include <vdbtet/Errors.h>

#include <tbb/concurrent_queue.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vdbtet {

using openvdb::Vec3d;

namespace {

/// The positions of a chunk.
struct Positions {
    std::vector<Vec3d> points, centroids;
};

} // namespace

struct MeshScaler::Impl {
    MeshSink& next;
    double factor;
    tbb::concurrent_queue<Positions> spare; ///< memory that chunks before have left

    ArrayView<Vec3d> scaled(const ArrayView<Vec3d>& from, std::vector<Vec3d>& to) const {
        to.resize(from.size());
        std::transform(from.begin(), from.end(), to.begin(), [this](const Vec3d& p) { return factor * p; });
        return {to.data(), to.size()};
    }
};

MeshScaler::MeshScaler(MeshSink& next, double factor) : mImpl(new Impl{next, factor, {}}) {
    if (!(factor > 0.0) || !std::isfinite(factor))
        throw BadOption("the factor of a mesh's coordinates must be a positive number");
}

MeshScaler::~MeshScaler() = default;

bool MeshScaler::begin(const MeshTotals& totals) {
    const auto largest = [](const openvdb::BBoxd& box) {
        double most = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            most = std::max({most, std::abs(box.min()[axis]), std::abs(box.max()[axis])});
        return most;
    };
    MeshTotals scaled = totals;
    scaled.bounds = openvdb::BBoxd(mImpl->factor * totals.bounds.min(), mImpl->factor * totals.bounds.max());
    const double before = largest(totals.bounds), after = largest(scaled.bounds);
    if (!std::isfinite(after) || (before > 0.0 && !(after > 1e-290)))
        throw TooLarge("the factor takes the mesh's coordinates out of the range of double precision");
    // A spacing is at least 1e-8 of the coordinates that float32 can do for.
    scaled.float32Suffices = totals.float32Suffices && after < 1e38 && after > 1e-22;
    return mImpl->next.begin(scaled);
}

void MeshScaler::chunk(const MeshChunk& chunk) {
    MeshChunk scaled = chunk;
    Positions positions;
    mImpl->spare.try_pop(positions);
    scaled.points = mImpl->scaled(chunk.points, positions.points);
    scaled.centroids = mImpl->scaled(chunk.centroids, positions.centroids);
    mImpl->next.chunk(scaled);
    mImpl->spare.push(std::move(positions));
}

void MeshScaler::end() { mImpl->next.end(); }
bool MeshScaler::concurrent() const { return mImpl->next.concurrent(); }
MeshWants MeshScaler::wants() const { return mImpl->next.wants(); }

} // namespace vdbtet
