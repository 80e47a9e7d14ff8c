/// @file OutputFile.cc
/// Temporary file, positioned writes, rename.
#include "io/OutputFile.h"

#include <vdbtet/Errors.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace vdbtet {

namespace {

/// The file that opening @a path would write to. Only the last component is resolved: the kernel follows the
/// directories by itself.
std::filesystem::path followLinks(std::filesystem::path path) {
    // Linux gives up after 40 links too; what is left is then a loop, and renaming would destroy it.
    for (int i = 0; i < 40; ++i) {
        std::error_code error;
        const auto link = std::filesystem::read_symlink(path, error);
        if (error) return path;
        path = link.is_absolute() ? link : path.parent_path() / link;
    }
    throw FileError("cannot write " + path.string() + ": " + std::strerror(ELOOP));
}

} // namespace

OutputFile::OutputFile(const std::string& path) : mPath(path), mTarget(followLinks(path)) {
    struct stat old = {};
    const bool replaces = ::stat(mTarget.c_str(), &old) == 0;
    if (!replaces && errno != ENOENT) fail(errno);
    if (replaces && S_ISDIR(old.st_mode)) fail(EISDIR);
    if (replaces && !S_ISREG(old.st_mode)) {
        throw FileError("cannot write " + mPath + ": it is not a regular file");
    }
    // A rename would replace a write-protected file without asking.
    if (replaces && ::access(mTarget.c_str(), W_OK) != 0) fail(errno);

    const auto directory = std::filesystem::path(mTarget).parent_path();
    for (int attempt = 0; mFd < 0; ++attempt) {
        // Not derived from the target's name, which may be as long as a name can be.
        const auto name = ".vdbtet-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp";
        mTemporary = directory / name;
        mFd = ::open(mTemporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (mFd < 0 && errno != EEXIST) {
            const int error = errno;
            mTemporary.clear();
            fail(error);
        }
    }
    // Fails where the file system has no permissions, which is no reason to refuse.
    if (replaces) static_cast<void>(::fchmod(mFd, old.st_mode & 0777));
}

OutputFile::~OutputFile() {
    if (mFd >= 0) ::close(mFd);
    if (!mTemporary.empty()) ::unlink(mTemporary.c_str());
}

void OutputFile::reserve(std::uint64_t size) {
    if (size == 0) return;
#ifdef __linux__
    // posix_fallocate() would write every block by hand on a file system that cannot reserve.
    if (::fallocate(mFd, 0, 0, static_cast<off_t>(size)) == 0) return;
    if (errno == ENOSPC || errno == EFBIG || errno == EDQUOT) fail(errno);
#endif
}

void OutputFile::writeAt(std::uint64_t offset, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::pwrite(mFd, bytes, size, static_cast<off_t>(offset));
        if (written < 0) {
            if (errno == EINTR) continue;
            fail(errno);
        }
        bytes += written;
        offset += static_cast<std::uint64_t>(written);
        size -= static_cast<std::size_t>(written);
    }
}

void OutputFile::commit() {
    // Network file systems report a full disk no earlier than here. The descriptor is gone either way.
    const int fd = mFd;
    mFd = -1;
    if (::close(fd) != 0 && errno != EINTR) fail(errno);
    if (std::rename(mTemporary.c_str(), mTarget.c_str()) != 0) fail(errno);
    mTemporary.clear();
}

void OutputFile::fail(int error) const {
    throw FileError("cannot write " + mPath + ": " + std::strerror(error));
}

} // namespace vdbtet
