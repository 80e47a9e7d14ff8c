/// @file Memory.h
/// How much memory there is for jobs, and how many of them fit.
#pragma once

#include <vdbtet/VolumeToTets.h>

#include <cstdint>
#include <optional>
#include <string>

/// @return the bytes that can be had without swapping, by /proc/meminfo and the limits of this process's
/// control groups; nothing where neither tells
/// @param root  of the file system, for tests
std::optional<std::int64_t> freeMemory(const std::string& root = "");

/// @return @a options, whose limit on memory is what is free unless they have one.
/// @param grid  to be meshed, and in memory already
vdbtet::Options withMemoryLimit(vdbtet::Options options, const openvdb::GridBase& grid);

/// @return how many jobs may run at once: at least one, and at most @a threads
/// @param free  bytes, for all of them
/// @param peak  the most that one has taken
int jobsThatFit(std::int64_t free, std::int64_t peak, int threads);
