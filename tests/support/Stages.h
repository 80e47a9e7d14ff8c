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
    std::vector<TileSigns> signs;
    Layout layout;
    Arrows arrows;
    Labels labels;

    explicit Stages(const openvdb::FloatGrid& grid, double voxels = 1.0)
        : field(grid, makeFrame(grid.transform(), voxels * shortestVoxelEdge(grid.transform())),
                Level{0.0, true}),
          signs(findSigns(field, field.surfaceTiles(1 << 20, interrupt), interrupt)),
          layout(makeLayout(field.surfaceTiles(1 << 20, interrupt), signs)),
          arrows(field, layout, signs, interrupt), labels(labelVertices(layout, arrows, interrupt)) {}
};

} // namespace vdbtet::test
