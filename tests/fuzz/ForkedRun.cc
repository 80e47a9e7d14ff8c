/// @file ForkedRun.cc
/// fork(), with the counters of coverage in shared memory, and limits of time and memory.
#include "fuzz/ForkedRun.h"

#include <sanitizer/common_interface_defs.h>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

// The linker's names for what -fsanitize=fuzzer counts with.
extern "C" __attribute__((visibility("hidden"))) char __start___sancov_cntrs[], __stop___sancov_cntrs[];

namespace vdbtet::test {

namespace {

/// Exit codes: an outcome more than the first of these; sanitizers have 1.
constexpr int kEnded = 64, kTooMuch = 80;
constexpr long kMostKilobytes = 1 << 20, kMostSeconds = 10;

volatile Stage* theStage = nullptr; // shared, so that it outlives the child

void* share(void* where, std::size_t bytes) {
    void* memory = mmap(where, bytes, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS | (where ? MAP_FIXED : 0), -1, 0);
    if (memory != MAP_FAILED) return memory;
    std::perror("cannot share memory");
    std::abort();
}

/// Whole pages of counters. What lies in one page with other data is left out.
void shareCounters() {
    const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
    const auto first = (reinterpret_cast<std::uintptr_t>(__start___sancov_cntrs) + page - 1) / page * page;
    const auto last = reinterpret_cast<std::uintptr_t>(__stop___sancov_cntrs) / page * page;
    if (last > first) share(reinterpret_cast<void*>(first), last - first);
}

/// Address space cannot be limited under the address sanitizer.
void onTimer(int) {
    struct rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    if (usage.ru_maxrss > kMostKilobytes || usage.ru_utime.tv_sec > kMostSeconds) _exit(kTooMuch);
}

void limit() {
    for (const int number : {SIGABRT, SIGILL}) std::signal(number, SIG_DFL); // were libFuzzer's
    __sanitizer_set_death_callback(nullptr); // it would keep the input as a finding
    std::signal(SIGPROF, onTimer);
    const struct itimerval often = {{0, 50000}, {0, 50000}};
    setitimer(ITIMER_PROF, &often, nullptr);
}

std::string readAll(int file) {
    std::string text;
    char buffer[4096];
    lseek(file, 0, SEEK_SET);
    for (ssize_t got; (got = read(file, buffer, sizeof buffer)) > 0;) text.append(buffer, std::size_t(got));
    close(file);
    return text;
}

/// @brief Whether a sanitizer's report is of code of ours: the first name that it tells is.
/// @details Templates of OpenVDB's are compiled here, too, so places in memory tell nothing. What would be
/// std::bad_alloc without a sanitizer is no finding.
bool isOurs(const std::string& report) {
    for (const char* memory : {"allocation-size-too-big", "out-of-memory"})
        if (report.find(memory) != std::string::npos) return false;
    const std::size_t theirs = std::min(report.find("openvdb::"), report.find("/openvdb/"));
    const bool isReport = report.find("Sanitizer") != std::string::npos;
    return isReport && (theirs == std::string::npos || report.find("vdbtet::") < theirs);
}

} // namespace

Outcome runForked(const std::function<Outcome(const std::function<void(Stage)>& enter)>& work) {
    if (!theStage) {
        theStage = static_cast<Stage*>(share(nullptr, sizeof(Stage)));
        shareCounters();
    }
    *theStage = Stage::Reading;
    const int said = memfd_create("said", MFD_CLOEXEC);
    const pid_t child = fork();
    if (said < 0 || child < 0) {
        std::perror("cannot start a process");
        std::abort();
    }
    if (child == 0) {
        limit();
        dup2(said, STDOUT_FILENO);
        dup2(said, STDERR_FILENO);
        _exit(kEnded + int(work([](Stage stage) { *theStage = stage; })));
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const std::string report = readAll(said);
    const bool reading = *theStage == Stage::Reading;
    const bool ended = WIFEXITED(status) && WEXITSTATUS(status) >= kEnded && WEXITSTATUS(status) < kTooMuch;
    const Outcome outcome = ended                        ? Outcome(WEXITSTATUS(status) - kEnded)
                            : reading && !isOurs(report) ? Outcome::EndedInOpenVDB
                                                         : Outcome::Finding;
    if (outcome != Outcome::Finding) return outcome;
    std::fprintf(stderr, "%s\nstatus %d while %s\n", report.c_str(), status, reading ? "reading" : "working");
    std::abort();
}

} // namespace vdbtet::test
