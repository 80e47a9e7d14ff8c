/// @file ForkedRun.cc
/// fork(), with the counters of coverage in shared memory, and limits of time and memory.
#include "fuzz/ForkedRun.h"

#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

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

/// Whether code is this program's, not a library's.
bool isOwn(const void* code) {
    Dl_info at = {}, here = {};
    return dladdr(code, &at) == 0 || dladdr(reinterpret_cast<void*>(&shareCounters), &here) == 0 ||
           at.dli_fbase == here.dli_fbase;
}

[[noreturn]] void endEarly(bool own) {
    _exit(int(own || *theStage == Stage::Working ? Outcome::Finding : Outcome::EndedInOpenVDB));
}

/// A sanitizer has reported. Libraries have not been compiled with any, so theirs are reports by the address
/// sanitizer alone: of signals, and of calls such as memcpy(). It also ends what std::bad_alloc would.
void onDeath() {
    if (!__asan_report_present()) endEarly(true);
    const std::string what = __asan_get_report_description();
    const bool noMemory = what == "allocation-size-too-big" || what == "out-of-memory";
    endEarly(!noMemory && isOwn(__asan_get_report_pc()));
}

/// Address space cannot be limited under the address sanitizer.
void onTimer(int) {
    struct rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    if (usage.ru_maxrss > kMostKilobytes || usage.ru_utime.tv_sec > kMostSeconds) endEarly(false);
}

void limit() {
    for (const int number : {SIGABRT, SIGILL}) std::signal(number, SIG_DFL); // were libFuzzer's
    __sanitizer_set_death_callback(onDeath);
    std::signal(SIGPROF, onTimer);
    const struct itimerval often = {{0, 50000}, {0, 50000}};
    setitimer(ITIMER_PROF, &often, nullptr);
}

void print(int file) {
    char buffer[4096];
    lseek(file, 0, SEEK_SET);
    for (ssize_t got; (got = read(file, buffer, sizeof buffer)) > 0;)
        if (write(STDERR_FILENO, buffer, std::size_t(got)) != got) return;
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
        _exit(int(work([](Stage stage) { *theStage = stage; })));
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const bool reading = *theStage == Stage::Reading;
    const Outcome outcome = WIFEXITED(status) ? Outcome(WEXITSTATUS(status))
                            : reading         ? Outcome::EndedInOpenVDB
                                              : Outcome::Finding;
    if (outcome == Outcome::Finding) {
        print(said);
        std::fprintf(stderr, "status %d while %s\n", status, reading ? "reading" : "working");
        std::abort();
    }
    close(said);
    return outcome;
}

} // namespace vdbtet::test
