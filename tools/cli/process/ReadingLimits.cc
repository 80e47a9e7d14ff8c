/// @file ReadingLimits.cc
/// From the size of the file.
#include "process/ReadingLimits.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimited = false;
#else
constexpr bool kLimited = true;
#endif

/// Each leaf of 8^3 voxels has a mask of 64 bytes in the file, never compressed, and takes 12 kB at most,
/// where its values are vectors of double.
constexpr rlim_t kBytesPerByte = 256, kBytes = rlim_t(512) << 20;
/// Blosc and zlib do a hundred times as much a second.
constexpr rlim_t kBytesPerSecond = 1 << 20, kSeconds = 15;

void lower(int resource, const rlimit& now, rlim_t most) {
    const rlimit lower = {std::min(now.rlim_cur, most), now.rlim_max};
    setrlimit(resource, &lower);
}

} // namespace

ReadingLimits::ReadingLimits(const std::string& path) {
    getrlimit(RLIMIT_DATA, &mMemory);
    getrlimit(RLIMIT_CPU, &mTime);
    std::error_code error;
    const auto size = rlim_t(std::filesystem::file_size(path, error));
    if (error || !kLimited) return;
    lower(RLIMIT_DATA, mMemory, kBytes + kBytesPerByte * size);
    lower(RLIMIT_CPU, mTime, kSeconds + size / kBytesPerSecond);
}

ReadingLimits::~ReadingLimits() {
    setrlimit(RLIMIT_DATA, &mMemory);
    setrlimit(RLIMIT_CPU, &mTime);
}
