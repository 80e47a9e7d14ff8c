/// @file Memory.cc
/// Reads what the kernel tells, of control groups of either version.
#include "batch/Memory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;

/// The number after a key at the start of a line; without a key, the first of the file.
std::optional<std::int64_t> numberIn(const fs::path& file, const std::string& key = {}) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind(key, 0) != 0) continue;
        std::istringstream rest(line.substr(key.size()));
        std::int64_t number = 0;
        if (rest >> number) return number;
    }
    return std::nullopt;
}

/// What the group at @a folder, or one that it is in, leaves.
void lower(std::optional<std::int64_t>& free, const fs::path& top, const fs::path& folder, const char* limit,
           const char* usage, const char* reclaimable) {
    for (fs::path at = top / folder.relative_path(); at != at.parent_path(); at = at.parent_path()) {
        const auto most = numberIn(at / limit), used = numberIn(at / usage); // no number: no limit
        if (most && used) {
            const std::int64_t cache = numberIn(at / "memory.stat", reclaimable).value_or(0);
            const std::int64_t left = std::max<std::int64_t>(*most - *used + cache, 0);
            free = std::min(free.value_or(left), left);
        }
        if (at == top || at == top / "") break;
    }
}

} // namespace

std::optional<std::int64_t> freeMemory(const std::string& root) {
    std::optional<std::int64_t> free = numberIn(root + "/proc/meminfo", "MemAvailable:");
    if (free) *free *= 1024;
    const fs::path groups = root + "/sys/fs/cgroup";
    std::ifstream stream(root + "/proc/self/cgroup");
    for (std::string line; std::getline(stream, line);) { // ID:CONTROLLERS:PATH
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const std::string folder = line.substr(second + 1);
        if (controllers == ",,")
            lower(free, groups, folder, "memory.max", "memory.current", "inactive_file ");
        if (controllers.find(",memory,") != std::string::npos) {
            lower(free, groups / "memory", folder, "memory.limit_in_bytes", "memory.usage_in_bytes",
                  "total_inactive_file ");
        }
    }
    return free;
}

vdbtet::Options withMemoryLimit(vdbtet::Options options, const openvdb::GridBase& grid) {
    const std::optional<std::int64_t> free = freeMemory();
    if (!options.maxMemory && free) options.maxMemory = *free + std::int64_t(grid.memUsage());
    return options;
}

int jobsThatFit(std::int64_t free, std::int64_t peak, int threads) {
    // The next frames may be larger.
    constexpr double kReserve = 1.5;
    const double fitting = double(free) / (kReserve * double(std::max<std::int64_t>(peak, 1)));
    return int(std::clamp(fitting, 1.0, double(std::max(threads, 1))));
}
