/// @file Faults.cc
/// Replacements that count.
#include "faults/Faults.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

struct Counter {
    std::atomic<bool> armed{false};
    std::atomic<std::int64_t> count{0}, failing{0};

    /// @return whether this one shall fail
    bool next() { return armed && ++count == failing; }
};
Counter gCounters[3];
std::atomic<std::int64_t> gLive{0};

Counter& counterOf(vdbtet::test::Fault kind) { return gCounters[int(kind)]; }

void* allocate(std::size_t size, std::size_t alignment) {
    if (counterOf(vdbtet::test::Fault::Allocation).next()) return nullptr;
    if (size == 0) size = 1;
    void* memory = alignment <= alignof(std::max_align_t)
                       ? std::malloc(size)
                       : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory) ++gLive;
    return memory;
}

void giveBack(void* memory) noexcept {
    if (memory) --gLive;
    std::free(memory);
}

void* allocateOrThrow(std::size_t size, std::size_t alignment) {
    void* memory = allocate(size, alignment);
    if (!memory) throw std::bad_alloc();
    return memory;
}

bool fails(vdbtet::test::Fault kind, int error) {
    if (!counterOf(kind).next()) return false;
    errno = error;
    return true;
}
bool writeFails() { return fails(vdbtet::test::Fault::Write, ENOSPC); }

} // namespace

namespace vdbtet::test {

FaultAt::FaultAt(Fault kind, std::int64_t n) : mKind(kind) {
    counterOf(kind).count = 0;
    counterOf(kind).failing = n;
    counterOf(kind).armed = true;
}

FaultAt::~FaultAt() { counterOf(mKind).armed = false; }

std::int64_t liveAllocations() { return gLive; }

std::int64_t FaultAt::count() const { return counterOf(mKind).count; }

} // namespace vdbtet::test

constexpr std::size_t kPlain = alignof(std::max_align_t);

void* operator new(std::size_t size) { return allocateOrThrow(size, kPlain); }
void* operator new[](std::size_t size) { return allocateOrThrow(size, kPlain); }
void* operator new(std::size_t size, std::align_val_t to) { return allocateOrThrow(size, std::size_t(to)); }
void* operator new[](std::size_t size, std::align_val_t to) { return allocateOrThrow(size, std::size_t(to)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, kPlain); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, kPlain); }
void operator delete(void* memory) noexcept { giveBack(memory); }
void operator delete[](void* memory) noexcept { giveBack(memory); }
void operator delete(void* memory, std::size_t) noexcept { giveBack(memory); }
void operator delete[](void* memory, std::size_t) noexcept { giveBack(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { giveBack(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { giveBack(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { giveBack(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { giveBack(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { giveBack(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { giveBack(memory); }

extern "C" {

ssize_t pwrite(int fd, const void* data, std::size_t size, off_t offset) {
    return writeFails() ? -1 : ssize_t(::syscall(SYS_pwrite64, fd, data, size, offset));
}

int linkat(int from, const char* old, int to, const char* path, int flags) noexcept {
    return writeFails() ? -1 : int(::syscall(SYS_linkat, from, old, to, path, flags));
}

int rename(const char* old, const char* path) noexcept {
    return fails(vdbtet::test::Fault::Rename, ENOENT)
               ? -1
               : int(::syscall(SYS_renameat2, AT_FDCWD, old, AT_FDCWD, path, 0));
}

} // extern "C"
