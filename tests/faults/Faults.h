/// @file Faults.h
/// Makes one of the things fail that can fail at any time: an allocation, or a write.
///
/// This executable has its own operator new, pwrite(), linkat() and rename(), which the linker takes for
/// those of the libraries; so what is tested has no hooks.
#pragma once

#include <cstdint>

namespace vdbtet::test {

/// What can be made to fail.
enum class Fault {
    Allocation, ///< operator new, of any thread: std::bad_alloc
    Write,      ///< pwrite() and linkat(): the disk is full
    Rename      ///< rename(), which can fail where the folder is gone
};

/// While it lives, the n-th of its kind fails, and no other.
class FaultAt {
public:
    /// @param n  from 1; with 0 none fails, but they are counted
    FaultAt(Fault kind, std::int64_t n);
    ~FaultAt();
    FaultAt(const FaultAt&) = delete;
    FaultAt& operator=(const FaultAt&) = delete;

    /// How many there have been so far.
    std::int64_t count() const;

private:
    Fault mKind;
};

/// @return how many allocations by operator new have not been given back
std::int64_t liveAllocations();

} // namespace vdbtet::test
