/// @file Partition.cc
/// Keys by the bits of coordinates, interleaved.
#include "mpi/Partition.h"

#include <tbb/parallel_sort.h>

#include <algorithm>

namespace vdbtet::mpi {

namespace {

constexpr int kKeyBits = 21; ///< an axis

/// Put two zeros between any two bits.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

} // namespace

CurvePartition::CurvePartition(const std::vector<Work>& work, int parts) {
    for (const auto& [place, amount] : work) mBox.expand(place);
    for (int axis = 0; axis < 3 && !work.empty(); ++axis) {
        const std::int64_t extent = std::int64_t(mBox.max()[axis]) - mBox.min()[axis];
        while (extent >> mShift >> kKeyBits != 0) ++mShift;
    }
    std::vector<std::pair<std::uint64_t, std::int64_t>> keys;
    keys.reserve(work.size());
    std::int64_t total = 0;
    for (const auto& [place, amount] : work) {
        keys.emplace_back(keyOf(place), amount);
        total += amount;
    }
    tbb::parallel_sort(keys.begin(), keys.end());
    std::int64_t before = 0;
    for (const auto& [key, amount] : keys) {
        while (int(mStarts.size()) + 1 < parts &&
               double(before) + 0.5 * double(amount) >= double(mStarts.size() + 1) * double(total) / parts)
            mStarts.push_back(key);
        before += amount;
    }
    mStarts.resize(std::size_t(parts) - 1, ~std::uint64_t(0));
}

int CurvePartition::operator()(const openvdb::Coord& place) const {
    return int(std::upper_bound(mStarts.begin(), mStarts.end(), keyOf(place)) - mStarts.begin());
}

std::uint64_t CurvePartition::keyOf(const openvdb::Coord& place) const {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int at = std::clamp(place[axis], mBox.min()[axis], mBox.max()[axis]);
        key |= spread(std::uint64_t(std::int64_t(at) - mBox.min()[axis]) >> mShift) << (2 - axis);
    }
    return key;
}

} // namespace vdbtet::mpi
