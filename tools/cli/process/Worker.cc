/// @file Worker.cc
/// fork(), a pipe, and messages in CBOR, which keeps names in any encoding, each after its length.
#include "process/Worker.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <vector>

namespace {

using Length = std::uint32_t;

/// What a child prints is its libraries' chatter.
void silence(int fd) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, fd);
    ::close(nowhere);
}

void dieWith(pid_t parent) {
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (::getppid() != parent) ::_exit(1); // it has ended meanwhile
}

} // namespace

void Channel::send(const nlohmann::json& message) const {
    const std::vector<std::uint8_t> body = nlohmann::json::to_cbor(message);
    const auto length = Length(body.size());
    std::string bytes(reinterpret_cast<const char*>(&length), sizeof length);
    bytes.append(body.begin(), body.end());
    // One write is one piece up to PIPE_BUF, whatever other threads write.
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t written = ::write(mFd, bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno != EINTR) return; // no one is left to be told
        if (written > 0) done += std::size_t(written);
    }
}

Worker::Worker(const Signals& signals, const std::function<int(const Channel&)>& work) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "cannot open a pipe");
    std::fflush(nullptr); // or the child would write it again
    const pid_t parent = ::getpid();
    mPid = ::fork();
    if (mPid == 0) {
        ::close(ends[0]);
        dieWith(parent);
        silence(STDOUT_FILENO);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        silence(STDERR_FILENO);
#endif
        signals.unblock();
        // Not exit(): libraries of OpenVDB's have threads of their own since before main(), which a child has
        // not, and some wait for them at the end.
        ::_exit(work(Channel(ends[1])));
    }
    const int error = errno;
    ::close(ends[1]);
    mFd = ends[0];
    if (mPid > 0) return;
    ::close(mFd);
    throw std::system_error(error, std::generic_category(), "cannot start a process");
}

Worker::~Worker() {
    signal(SIGKILL);
    reap();
    ::close(mFd);
}

bool Worker::receive(const std::function<void(const nlohmann::json&)>& handle) {
    char buffer[1 << 16];
    const ssize_t got = ::read(mFd, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) return true;
    if (got <= 0) {
        reap();
        return false;
    }
    mReceived.append(buffer, std::size_t(got));
    std::size_t at = 0;
    for (Length length; mReceived.size() - at >= sizeof length;) {
        std::memcpy(&length, mReceived.data() + at, sizeof length);
        if (mReceived.size() - at - sizeof length < length) break;
        const auto begin = mReceived.begin() + std::ptrdiff_t(at + sizeof length);
        // A child that a damaged file has led astray may say anything.
        const auto message = nlohmann::json::from_cbor(begin, begin + std::ptrdiff_t(length), true, false);
        if (message.is_object() || message.is_array()) handle(message);
        at += sizeof length + length;
    }
    mReceived.erase(0, at);
    return true;
}

void Worker::signal(int number) const {
    if (mPid > 0) ::kill(mPid, number);
}

void Worker::reap() {
    if (mPid < 0) return;
    int status = 0;
    struct rusage usage = {};
    pid_t ended = 0;
    while ((ended = ::wait4(mPid, &status, 0, &usage)) < 0 && errno == EINTR) {
    }
    mEnd.pid = mPid;
    mPid = -1;
    if (ended < 0) return;
    mEnd.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    mEnd.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
#ifdef __APPLE__
    mEnd.peakMemory = usage.ru_maxrss;
#else
    mEnd.peakMemory = std::int64_t(usage.ru_maxrss) * 1024;
#endif
}
