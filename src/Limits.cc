/// @file Limits.cc
/// Bytes a tile, measured, and messages with the figures.
#include "Limits.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

namespace vdbtet {

namespace {

/// Such as 9.1 GB.
std::string gigabytes(std::int64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g GB", 1e-9 * double(bytes));
    return text;
}

/// @param tets  how many more than the limit
[[noreturn]] void throwTooMany(const std::string& tets, const Options& options) {
    throw TooLarge("the mesh would have " + tets + " than the limit of " + std::to_string(options.maxTets) +
                   "; use a coarser spacing, " + (options.grade ? "" : "grade the inside, ") +
                   "or raise the limit");
}

} // namespace

std::int64_t estimateMemory(std::int64_t surfaceTiles, const Options& options) {
    // Chunks in flight, stacks and the libraries' own.
    constexpr std::int64_t kAnyRun = 60'000'000;
    std::int64_t tile = 1500;
    if (options.tiger == 3) tile += 1500;
    if (options.optimize) tile += 1000;
    return kAnyRun + surfaceTiles * tile;
}

void requireMemory(std::int64_t bytes, const Options& options, const char* what) {
    if (!options.maxMemory || bytes <= *options.maxMemory) return;
    throw TooLarge(std::string(what) + " would take about " + gigabytes(bytes) +
                   " of memory, more than the limit of " + gigabytes(*options.maxMemory) +
                   "; use a coarser spacing, or raise the limit");
}

std::int64_t mostInsideTets(const Options& options) {
    return options.grade ? std::numeric_limits<std::int64_t>::max() : options.maxTets;
}

void requireFewInsideTets(std::int64_t insideTets, const Options& options) {
    // How many there are depends on the threads: counting ends when the limit is passed.
    if (insideTets > mostInsideTets(options)) throwTooMany("more tets", options);
}

void requireFewTets(const Layout& layout, const Options& options) {
    if (options.grade) return;
    constexpr std::int64_t kTetsPerTile = 12 * TileMask::kSize;
    std::int64_t tiles = 0; // of 2^29 in each of 2^30 columns at most
    for (const Span& span : layout.spans) tiles += span.tile == kInside ? span.count : 0;
    if (tiles <= options.maxTets / kTetsPerTile) return;
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / kTetsPerTile;
    throwTooMany("at least " + std::to_string(std::min(tiles, kMost) * kTetsPerTile) + " tets, more",
                 options);
}

void requireFewTets(std::int64_t tets, const Options& options) {
    if (tets > options.maxTets) throwTooMany(std::to_string(tets) + " tets, more", options);
}

} // namespace vdbtet
