/// @file Angles.h
/// Sums up the dihedral angles of very many tets, by their cosines.
#pragma once

#include <vdbtet/Quality.h>

#include <cstdint>

namespace vdbtet {

class AngleSum {
public:
    /// Add the six angles of a tet.
    void add(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
             const openvdb::Vec3d& d);

    /// Add @a count tets of the lattice itself: four angles of 60 and two of 90 degrees each.
    void addLatticeTets(std::int64_t count) { mLatticeTets += count; }

    AngleSum& operator+=(const AngleSum& other);

    AngleStats stats() const;

private:
    double mMinCos = 1.0, mMaxCos = -1.0;
    std::array<std::int64_t, 18> mHistogram{};
    std::int64_t mLatticeTets = 0;
};

} // namespace vdbtet
