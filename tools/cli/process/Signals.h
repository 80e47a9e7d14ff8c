/// @file Signals.h
/// Ctrl-C and kill are noted, and end a run tidily.
#pragma once

#include <csignal>

/// @brief Notes SIGINT, SIGTERM and SIGHUP, of which those stay ignored that are ignored already. One object
/// a program.
/// @details They are blocked but while the program waits, so that none is missed in between. Also ignores
/// SIGXFSZ, so that a file that grows too large is an error as a full disk is.
class Signals {
public:
    Signals();
    ~Signals() { unblock(); }
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    /// @return the signal that came first, or 0
    static int first();
    /// @return how many have come
    static int count();

    /// The mask to wait with, for ppoll().
    const sigset_t& whileWaiting() const { return mOutside; }
    /// Take note of what has come since.
    void check() const;
    /// From now on note them at once: for a child.
    void unblock() const;

private:
    sigset_t mOutside, mBlocked;
};
