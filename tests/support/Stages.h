/// @file Stages.h
/// The products of the first stages, for tests that look inside the pipeline.
#pragma once

#include "bcc/Frame.h"
#include "cuts/Arrows.h"
#include "field/GridField.h"
#include "labels/Labels.h"
#include "tiles/Layout.h"

#include <vdbtet/VolumeToTets.h>

namespace vdbtet::test {

/// A level set up to its labels.
struct Stages {
    Interrupt interrupt{nullptr};
    GridField<openvdb::FloatGrid> field;
    std::vector<openvdb::Coord> tiles;
    Cuts cuts;
    Layout layout;
    Labels labels;

    explicit Stages(const openvdb::FloatGrid& grid, double voxels = 1.0, int margin = 0)
        : field(grid, makeFrame(grid.transform(), voxels * shortestVoxelEdge(grid.transform())),
                Level{0.0, true}),
          tiles(field.surfaceTiles(1 << 20, margin, interrupt)), cuts(findCuts(field, tiles, 0.5, interrupt)),
          layout(makeLayout(tiles, cuts.signs, interrupt)),
          labels(labelVertices(layout, cuts.arrows, interrupt)) {}
};

/// The inside vertices of a tile.
inline TileSigns signsOf(Field::Sampler& sampler, const openvdb::Coord& tile) {
    PaddedMask a, b;
    sampler.signs(tile, a, b);
    return {a.core(), b.core()};
}

} // namespace vdbtet::test
