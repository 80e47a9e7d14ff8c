/// @file Worker.h
/// A child process that works, and tells its parent by messages through a pipe.
#pragma once

#include "process/Signals.h"

#include <nlohmann/json.hpp>

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>

/// The child's end of the pipe.
class Channel {
public:
    explicit Channel(int fd) : mFd(fd) {}
    /// From any thread, if the message is small. Waits where the parent does not read.
    void send(const nlohmann::json& message) const;

private:
    int mFd;
};

/// @brief A forked process, with the memory of this one as it is now. The parent must use no other thread.
/// @details It dies with its parent (on Linux, however that ends), and has no standard output. Signals reach
/// it as they reach the parent.
class Worker {
public:
    /// @param work  what the child does; must not throw. Its result is the exit code
    /// @throw std::system_error where no process can be had
    Worker(const Signals& signals, const std::function<int(const Channel&)>& work);
    /// Kills the child if it is still there.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    pid_t pid() const { return mPid; }
    /// To wait for.
    int fd() const { return mFd; }
    /// @brief Read what has come; waits where nothing has.
    /// @return false once the child has ended, and end() tells how
    bool receive(const std::function<void(const nlohmann::json&)>& handle);
    void signal(int number) const;

    struct End {
        pid_t pid = -1;              ///< that it had
        int signal = 0;              ///< that killed it, or 0
        int code = 0;                ///< exit code
        std::int64_t peakMemory = 0; ///< resident, in bytes
    };
    const End& end() const { return mEnd; }

private:
    void reap();

    pid_t mPid = -1; ///< -1 once it has ended
    int mFd = -1;
    std::string mReceived;
    End mEnd;
};
