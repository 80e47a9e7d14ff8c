/// @file MemoryLimit.h
/// Makes what would eat all memory fail at once instead.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace vdbtet::test {

/// While it lives, the process cannot grow by more than so many bytes of address space; allocations beyond
/// throw std::bad_alloc. Without effect under the address sanitizer, which needs terabytes of it.
class MemoryLimit {
public:
    explicit MemoryLimit(std::uint64_t bytes) {
        getrlimit(RLIMIT_AS, &mBefore);
#ifndef __SANITIZE_ADDRESS__
        std::uint64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        rlimit limit = mBefore;
        limit.rlim_cur = rlim_t(pages * std::uint64_t(sysconf(_SC_PAGESIZE)) + bytes);
        setrlimit(RLIMIT_AS, &limit);
#else
        static_cast<void>(bytes);
#endif
    }
    ~MemoryLimit() { setrlimit(RLIMIT_AS, &mBefore); }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
    rlimit mBefore{};
};

} // namespace vdbtet::test
