/// @file SignalInterrupter.h
/// Ctrl-C and kill end a run tidily.
#pragma once

#include <openvdb/util/NullInterrupter.h>

/// @brief Says stop once SIGINT, SIGTERM or SIGHUP has arrived. One object a program.
/// @details Also ignores SIGXFSZ, so that a file that grows too large is an error as a full disk is.
class SignalInterrupter final : public openvdb::util::NullInterrupter {
public:
    SignalInterrupter();
    bool wasInterrupted(int percent = -1) override;
    /// @return the signal that arrived, or 0
    int signal() const;
};
