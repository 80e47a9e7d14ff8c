/// @file Level.h
/// From voxel values to the paper's phi, which is positive inside.
#pragma once

namespace vdbtet {

struct Level {
    double isovalue;
    bool insideIsBelow;

    double phi(double value) const { return insideIsBelow ? isovalue - value : value - isovalue; }
};

} // namespace vdbtet
