/// @file ThirdStages.h
/// Version 3 up to its guard, for tests that look inside the pipeline.
#pragma once

#include "guard/Guard.h"
#include "support/Stages.h"

#include <vector>

namespace vdbtet::test {

/// A level set up to the flips of version 3; guard() goes on.
struct ThirdStages {
    Interrupt interrupt{nullptr};
    double tau;
    GridField<openvdb::FloatGrid> field;
    std::vector<openvdb::Coord> tiles;
    Cuts cuts;
    Layout layout;
    Labels labels;
    Destinations destinations;
    Vertices vertices{layout, cuts.signs, labels, destinations};
    QualityFlips flips{vertices};
    VertexMasks flagged;

    /// @param grid  must outlive this
    explicit ThirdStages(const openvdb::FloatGrid& grid, double voxels = 1.0, double threshold = kDefaultTau)
        : ThirdStages(grid, voxels, threshold, {}) {}

    /// From scratch, with some vertices flagged; empty for none.
    ThirdStages(const openvdb::FloatGrid& grid, double voxels, double threshold, const VertexMasks& flags)
        : tau(threshold),
          field(grid, makeFrame(grid.transform(), voxels * shortestVoxelEdge(grid.transform())),
                Level{0.0, true}),
          tiles(field.surfaceTiles(1 << 20, 0, interrupt)), cuts(findCuts(field, tiles, tau, interrupt)),
          layout(makeLayout(tiles, cuts.signs, interrupt)), flagged(flags) {
        flagged.resize(layout.surfaceTiles.size());
        const Threshold flaggedToo{tau, &flagged};
        if (!flags.empty()) turnArrows(field, layout, flaggedToo, cuts.arrows.tiles, cuts.arrows, interrupt);
        labels = labelVertices(layout, cuts.arrows, interrupt);
        destinations = findGradientDestinations(field, layout, cuts.arrows, labels, flaggedToo, nullptr,
                                                nullptr, interrupt);
        flips.chooseAll(interrupt);
    }
    ThirdStages(const ThirdStages&) = delete;
    ThirdStages& operator=(const ThirdStages&) = delete;

    Guarded guard() {
        Guarded guarded =
            guardAngles(field, tau, vertices, {cuts.arrows, labels, destinations, flips}, interrupt);
        flagged = guarded.flagged;
        return guarded;
    }
};

} // namespace vdbtet::test
