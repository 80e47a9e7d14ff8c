/// @file OutputFile.cc
/// Temporary file, positioned writes, rename.
#include "io/OutputFile.h"

#include <vdbtet/Errors.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

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

std::string temporaryPrefix(int pid) { return ".vdbtet-" + std::to_string(pid) + "-"; }

/// Find a name beside the target that is not taken, for a file that @a make(path) makes.
/// @return what that returns, or -1 and errno
template <typename Make>
int makeBeside(const std::string& target, std::string& path, const Make& make) {
    const auto directory = std::filesystem::path(target).parent_path();
    for (int attempt = 0;; ++attempt) {
        // Not derived from the target's name, which may be as long as a name can be.
        path = directory / (temporaryPrefix(::getpid()) + std::to_string(attempt) + ".tmp");
        const int result = make(path.c_str());
        if (result >= 0 || errno != EEXIST) return result;
    }
}

/// @return the descriptor of a new file, or -1 and errno
int makeTemporary(const std::string& target, std::string& path) {
    return makeBeside(target, path, [](const char* name) {
        return ::open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    });
}

std::string nameOfDescriptor(int fd) { return "/proc/self/fd/" + std::to_string(fd); }

/// Make a file without a name, of which nothing is left however the process ends.
/// @return its descriptor, or -1 where there are none, or they can get no name later
int makeNameless(const std::string& target) {
#ifdef O_TMPFILE
    const auto directory = std::filesystem::path(target).parent_path();
    const int fd = ::open(directory.empty() ? "." : directory.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
    if (fd < 0 || ::access(nameOfDescriptor(fd).c_str(), F_OK) == 0) return fd;
    ::close(fd);
#endif
    return -1;
}

/// @return 0 or the error's number
int writeAll(int fd, std::uint64_t offset, const void* data, std::size_t size) {
    const auto* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::pwrite(fd, bytes, size, static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes += written;
        offset += static_cast<std::uint64_t>(written);
        size -= static_cast<std::size_t>(written);
    }
    return 0;
}

/// @return 0 or the error's number
int readAll(int fd, std::uint64_t offset, void* data, std::size_t size) {
    auto* bytes = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t got = ::pread(fd, bytes, size, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) break;
        bytes += got;
        offset += static_cast<std::uint64_t>(got);
        size -= static_cast<std::size_t>(got);
    }
    return 0;
}

} // namespace

OutputFile::OutputFile(const std::string& path) : mPath(path), mTarget(followLinks(path)) { open(false); }

OutputFile::OutputFile(const std::string& path, Shared) : mPath(path), mTarget(followLinks(path)) {
    open(true);
}

OutputFile::OutputFile(const std::string& path, const std::string& temporary) : mPath(path) {
    mFd = ::open(temporary.c_str(), O_RDWR | O_CLOEXEC);
    if (mFd < 0) fail(errno);
}

void OutputFile::open(bool named) {
    struct stat old = {};
    const bool replaces = ::stat(mTarget.c_str(), &old) == 0;
    if (!replaces && errno != ENOENT) fail(errno);
    if (replaces && S_ISDIR(old.st_mode)) fail(EISDIR);
    if (replaces && !S_ISREG(old.st_mode)) {
        throw FileError("cannot write " + mPath + ": it is not a regular file");
    }
    // A rename would replace a write-protected file without asking.
    if (replaces && ::access(mTarget.c_str(), W_OK) != 0) fail(errno);

    if (!named) mFd = makeNameless(mTarget);
    if (mFd < 0) mFd = makeTemporary(mTarget, mTemporary);
    if (mFd < 0) {
        const int error = errno;
        mTemporary.clear();
        fail(error);
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
    if (const int error = writeAll(mFd, offset, data, size)) fail(error);
}

void OutputFile::readAt(std::uint64_t offset, void* data, std::size_t size) const {
    if (const int error = readAll(mFd, offset, data, size)) fail(error);
}

void OutputFile::prepare() {
    if (mFd < 0) return;
    if (mTemporary.empty()) {
        const auto link = [this](const char* name) {
            return ::linkat(AT_FDCWD, nameOfDescriptor(mFd).c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW);
        };
        if (makeBeside(mTarget, mTemporary, link) != 0) {
            const int error = errno;
            mTemporary.clear();
            fail(error);
        }
    }
    // Network file systems report a full disk no earlier than here. The descriptor is gone either way.
    leave();
}

void OutputFile::leave() {
    const int fd = mFd;
    mFd = -1;
    if (::close(fd) != 0 && errno != EINTR) fail(errno);
}

void OutputFile::commit() {
    prepare();
    if (std::rename(mTemporary.c_str(), mTarget.c_str()) != 0) fail(errno);
    mTemporary.clear();
}

void OutputFile::removeLeft(const std::string& path, int pid) {
    const auto directory = followLinks(path).parent_path();
    std::error_code error; // what cannot be listed or removed stays
    std::vector<std::filesystem::path> left;
    for (std::filesystem::directory_iterator entry(directory.empty() ? "." : directory, error), none;
         !error && entry != none; entry.increment(error)) {
        if (entry->path().filename().string().rfind(temporaryPrefix(pid), 0) == 0)
            left.push_back(entry->path());
    }
    for (const auto& file : left) std::filesystem::remove(file, error);
}

void OutputFile::fail(int error) const {
    throw FileError("cannot write " + mPath + ": " + std::strerror(error));
}

SpoolFile::SpoolFile(OutputFile& target) : mTarget(target) {
    std::string name;
    mFd = makeNameless(target.mTarget);
    if (mFd >= 0) return;
    mFd = makeTemporary(target.mTarget, name);
    if (mFd < 0) target.fail(errno);
    ::unlink(name.c_str());
}

SpoolFile::~SpoolFile() { ::close(mFd); }

void SpoolFile::append(const void* data, std::size_t size) {
    if (const int error = writeAll(mFd, mSize, data, size)) mTarget.fail(error);
    mSize += size;
}

void SpoolFile::readAt(std::uint64_t offset, void* data, std::size_t size) const {
    if (const int error = readAll(mFd, offset, data, size)) mTarget.fail(error);
}

void SpoolFile::copyTo(std::uint64_t offset) const {
    std::vector<char> buffer(std::size_t(1) << 20);
    for (std::uint64_t done = 0; done < mSize; done += buffer.size()) {
        const auto some = std::size_t(std::min<std::uint64_t>(buffer.size(), mSize - done));
        if (const int error = readAll(mFd, done, buffer.data(), some)) mTarget.fail(error);
        mTarget.writeAt(offset + done, buffer.data(), some);
    }
}

} // namespace vdbtet
