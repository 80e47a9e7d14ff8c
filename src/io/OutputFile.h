/// @file OutputFile.h
/// A file that is written beside its target and takes the target's place only when it is whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace vdbtet {

/// @brief Owns a temporary file in the target's directory; commit() renames it, the destructor removes it.
/// @details Where the file system has files without a name the temporary file is such a one until commit(),
/// so that nothing is left of it even when the process is killed. A target that is a symbolic link stays one:
/// the file it points to is replaced. The new file has the old one's permissions, or those the umask grants.
/// Whoever opens the target meanwhile sees the old file. commit() does not wait for the disk: the promise
/// holds when the program dies, not when the machine does. Every member but the destructor throws FileError
/// with the target's path.
class OutputFile {
public:
    /// @throw FileError also when the target exists and is not a regular file, or may not be written
    explicit OutputFile(const std::string& path);
    ~OutputFile();

    /// For a file that several processes write: one of them makes and commits it, and the others join it by
    /// the name it has meanwhile. Nothing is left of it unless all of them are killed.
    struct Shared {};
    OutputFile(const std::string& path, Shared);
    OutputFile(const std::string& path, const std::string& temporary);
    /// The name it has meanwhile, where it has one.
    const std::string& temporary() const { return mTemporary; }
    /// Instead of commit(), for one that has joined: all that it wrote has been taken.
    void leave();

    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Take @a size bytes of disk space, so that a full disk shows before the work rather than after.
    void reserve(std::uint64_t size);
    void writeAt(std::uint64_t offset, const void* data, std::size_t size);
    /// What was written. Bytes behind the end of the file are left as they are.
    void readAt(std::uint64_t offset, void* data, std::size_t size) const;
    /// Do all of commit() that a full disk can hinder, so that of files that belong together none takes its
    /// place before all can.
    void prepare();
    void commit();
    const std::string& path() const { return mPath; }

    /// Remove what the process @a pid, which has ended, has left of a file for the target @a path.
    static void removeLeft(const std::string& path, int pid);

private:
    friend class SpoolFile;

    [[noreturn]] void fail(int error) const;
    void open(bool named);

    std::string mPath;
    std::string mTarget;    // mPath with the links followed
    std::string mTemporary; // empty where it has no name, and once committed
    int mFd = -1;
};

/// @brief A file beside an OutputFile for what has to wait for its place there.
/// @details It has no name, so nothing is left of it however the process ends. Throws like the OutputFile.
class SpoolFile {
public:
    /// @param target  lives longer
    explicit SpoolFile(OutputFile& target);
    ~SpoolFile();
    SpoolFile(const SpoolFile&) = delete;
    SpoolFile& operator=(const SpoolFile&) = delete;

    void append(const void* data, std::size_t size);
    std::uint64_t size() const { return mSize; }
    void readAt(std::uint64_t offset, void* data, std::size_t size) const;
    /// Copy all of it to the target.
    void copyTo(std::uint64_t offset) const;

private:
    OutputFile& mTarget;
    int mFd = -1;
    std::uint64_t mSize = 0;
};

} // namespace vdbtet
