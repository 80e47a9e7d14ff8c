/// @file Brick.h
/// A dense copy of a small box of voxels.
#pragma once

#include <openvdb/Types.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <vector>

namespace vdbtet {

template <typename GridT>
class Brick {
public:
    using ValueT = typename GridT::ValueType;

    /// Copy the voxels of @a box, which must not be empty, from its leaves and constant regions.
    void load(typename GridT::ConstAccessor& accessor, const openvdb::CoordBBox& box) {
        mMin = box.min();
        mSize = box.dim();
        mStride = openvdb::Coord(mSize.y() * mSize.z(), mSize.z(), 1);
        mValues.resize(std::size_t(box.volume()));
        const openvdb::CoordBBox leaves(box.min() >> 3, box.max() >> 3);
        for (auto leaf = leaves.begin(); leaf; ++leaf) {
            const openvdb::Coord origin(8 * (*leaf).x(), 8 * (*leaf).y(), 8 * (*leaf).z());
            openvdb::CoordBBox part = openvdb::CoordBBox::createCube(origin, 8);
            part.intersect(box);
            copy(accessor, part);
        }
    }

    /// @return the eight corners of the cube at @a low, p[4i+2j+k] at corner (i,j,k), or false where the
    /// brick has not all of them.
    template <typename Convert>
    bool corners(const openvdb::Coord& low, double (&p)[8], const Convert& convert) const {
        const openvdb::Coord at = low - mMin;
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] < 0 || at[axis] + 1 >= mSize[axis]) return false;
        }
        const ValueT* first = mValues.data() + index(at);
        for (int corner = 0; corner < 8; ++corner) {
            p[corner] =
                convert(first[(corner >> 2) * mStride.x() + (corner >> 1 & 1) * mStride.y() + (corner & 1)]);
        }
        return true;
    }

private:
    int index(const openvdb::Coord& at) const { return at.x() * mStride.x() + at.y() * mStride.y() + at.z(); }

    /// Copy what lies in one leaf, or in one constant region.
    void copy(typename GridT::ConstAccessor& accessor, const openvdb::CoordBBox& part) {
        const auto* leaf = accessor.probeConstLeaf(part.min());
        const ValueT constant = leaf ? ValueT() : accessor.getValue(part.min());
        const int length = part.max().z() - part.min().z() + 1;
        for (int x = part.min().x(); x <= part.max().x(); ++x) {
            for (int y = part.min().y(); y <= part.max().y(); ++y) {
                const openvdb::Coord start(x, y, part.min().z());
                ValueT* row = mValues.data() + index(start - mMin);
                if (leaf) {
                    std::copy_n(leaf->buffer().data() + leaf->coordToOffset(start), length, row);
                } else {
                    std::fill_n(row, length, constant);
                }
            }
        }
    }

    openvdb::Coord mMin, mSize, mStride;
    std::vector<ValueT> mValues;
};

} // namespace vdbtet
