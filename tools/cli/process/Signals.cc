/// @file Signals.cc
/// Signal handlers that set a number.
#include "process/Signals.h"

#include <atomic>
#include <initializer_list>

namespace {

std::atomic<int> gFirst{0}, gCount{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not lock");

extern "C" void onSignal(int signal) {
    if (gCount++ == 0) gFirst = signal;
}

} // namespace

Signals::Signals() {
    ::sigemptyset(&mBlocked);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old = {};
        struct sigaction action = {};
        ::sigaction(signal, nullptr, &old);
        if (old.sa_handler == SIG_IGN) continue; // nohup, or a shell's background job
        action.sa_handler = onSignal;
        action.sa_flags = SA_RESTART;
        ::sigaction(signal, &action, nullptr);
        ::sigaddset(&mBlocked, signal);
    }
    ::sigprocmask(SIG_BLOCK, &mBlocked, &mOutside);
    std::signal(SIGXFSZ, SIG_IGN);
}

int Signals::first() { return gFirst; }

int Signals::count() { return gCount; }

void Signals::check() const {
    ::sigprocmask(SIG_SETMASK, &mOutside, nullptr);
    ::sigprocmask(SIG_BLOCK, &mBlocked, nullptr);
}

void Signals::unblock() const { ::sigprocmask(SIG_SETMASK, &mOutside, nullptr); }
