/// @file GridField.h
/// A VDB grid as a Field: trilinear interpolation between voxel centres.
#pragma once

#include "bcc/Frame.h"
#include "field/Field.h"
#include "field/Level.h"
#include "field/SurfaceTiles.h"
#include "field/TrilinearProbe.h"
#include "field/TrilinearSampler.h"
#include "field/VoxelSampler.h"

namespace vdbtet {

template <typename GridT>
class GridField final : public Field {
public:
    /// The grid must outlive the field, and hold finite values only.
    GridField(const GridT& grid, const Frame& frame, const Level& level)
        : mGrid(grid), mFrame(frame), mLevel(level), mOnVoxels(frame.toIndex == openvdb::Mat3d::identity()) {}

    std::vector<openvdb::Coord> surfaceTiles(std::int64_t maxTiles, int margin,
                                             Interrupt& interrupt) const override {
        return tilesNearSurface(mGrid.tree(), mFrame, mLevel, maxTiles, margin, interrupt);
    }

    std::unique_ptr<Sampler> sampler() const override {
        if (mOnVoxels) return std::make_unique<VoxelSampler<GridT>>(mGrid, mLevel);
        return std::make_unique<TrilinearSampler<GridT>>(mGrid, mFrame, mLevel);
    }

    std::unique_ptr<Probe> probe() const override {
        return std::make_unique<TrilinearProbe<GridT>>(mGrid, mFrame, mLevel);
    }

private:
    const GridT& mGrid;
    Frame mFrame;
    Level mLevel;
    bool mOnVoxels;
};

} // namespace vdbtet
