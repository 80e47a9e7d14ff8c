/// @file ForkedRun.h
/// A run of a fuzzer in a process of its own, which may crash where it is allowed to.
#pragma once

#include <functional>

namespace vdbtet::test {

/// Where the run is.
enum class Stage {
    Reading, ///< OpenVDB reads, and may crash, loop, or take all memory: outcomes, unless in code of ours
    Working  ///< all of these are findings
};

enum class Outcome {
    Done,
    Refused,
    Finding,
    EndedInOpenVDB ///< never returned by the work itself
};

/// @brief Fork, work there, and wait.
/// @details The counters by which libFuzzer sees what was reached are memory that both processes share. What
/// the child prints is seen only if it is a finding.
/// @param work  told how to say where it is; must not throw
/// @return how it ended; a finding aborts this process, as libFuzzer expects it
Outcome runForked(const std::function<Outcome(const std::function<void(Stage)>& enter)>& work);

} // namespace vdbtet::test
