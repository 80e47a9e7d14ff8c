/// @file SignalInterrupter.cc
/// Signal handlers that set a flag.
#include "SignalInterrupter.h"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace {

std::atomic<int> gSignal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not lock");

extern "C" void onSignal(int signal) { gSignal = signal; }

} // namespace

SignalInterrupter::SignalInterrupter() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old = {};
        struct sigaction action = {};
        ::sigaction(signal, nullptr, &old);
        if (old.sa_handler == SIG_IGN) continue; // nohup, or a shell's background job
        action.sa_handler = onSignal;
        action.sa_flags = SA_RESTART;
        ::sigaction(signal, &action, nullptr);
    }
    std::signal(SIGXFSZ, SIG_IGN);
}

bool SignalInterrupter::wasInterrupted(int) { return gSignal != 0; }

int SignalInterrupter::signal() const { return gSignal; }
