/// @file JobLog.cc
/// Lines by nlohmann-json, appended.
#include "batch/JobLog.h"

#include <vdbtet/Errors.h>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>

namespace {

/// Such as 2013-05-07T12:34:56.789Z.
std::string now() {
    const auto time = std::chrono::system_clock::now().time_since_epoch();
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
    const std::time_t seconds = std::time_t(milliseconds / 1000);
    std::tm parts = {};
    ::gmtime_r(&seconds, &parts);
    std::array<char, 32> text;
    std::string result(text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S.", &parts));
    return result + std::to_string(1000 + milliseconds % 1000).substr(1) + "Z";
}

} // namespace

JobLog::JobLog(const std::string& path) {
    if (path.empty()) return;
    mFd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (mFd < 0) throw vdbtet::FileError("cannot write " + path + ": " + std::strerror(errno));
}

JobLog::~JobLog() {
    if (mFd >= 0) ::close(mFd);
}

bool JobLog::add(const char* event, const Job& job, std::size_t index,
                 const nlohmann::ordered_json& details) {
    if (mFd < 0) return true;
    nlohmann::ordered_json json = {
        {"event", event}, {"time", now()}, {"job", index + 1}, {"input", job.line.in}};
    if (!job.line.name.empty()) json["grid"] = job.line.name;
    if (job.frame) json["frame"] = *job.frame;
    if (!job.line.out.empty()) json["output"] = job.line.out;
    json.update(details);
    // Names may be in any encoding.
    const std::string text =
        json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    ssize_t written = -1;
    do {
        written = ::write(mFd, text.data(), text.size());
    } while (written < 0 && errno == EINTR);
    if (written == ssize_t(text.size())) return true;
    ::close(mFd);
    mFd = -1;
    return false;
}
