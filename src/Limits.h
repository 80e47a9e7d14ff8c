/// @file Limits.h
/// What a run will take, and whether it may.
#pragma once

#include "tiles/Layout.h"

#include <vdbtet/VolumeToTets.h>

#include <cstdint>

namespace vdbtet {

/// @return an estimate of the mesher's peak, bytes: without the grid, and without what the sink keeps
std::int64_t estimateMemory(std::int64_t surfaceTiles, const Options& options);

/// @param what  is to be done with that, and the grid
/// @throw TooLarge where they are more than Options::maxMemory
void requireMemory(std::int64_t bytes, const Options& options, const char* what = "meshing it");

/// @return how many inside tets of the uniform mesh are too many, as far as the mesh will have them
std::int64_t mostInsideTets(const Options& options);

/// @param insideTets  some of those that a uniform mesh will have
/// @throw TooLarge where they alone are more than Options::maxTets
void requireFewInsideTets(std::int64_t insideTets, const Options& options);

/// @throw TooLarge where the uniform inside has more tets than Options::maxTets by its interior tiles alone
void requireFewTets(const Layout& layout, const Options& options);

/// @throw TooLarge for more @a tets than Options::maxTets
void requireFewTets(std::int64_t tets, const Options& options);

} // namespace vdbtet
