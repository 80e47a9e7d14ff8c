/// @file mpi/MeshFile.h
/// One file that all ranks write.
#pragma once

#include <vdbtet/MeshFile.h>

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace vdbtet::mpi {

/// @brief As vdbtet::MeshFile, but each rank writes its own chunks: the file is the same, byte for byte.
/// @details The places of all records are known before the first one is written, so ranks write without a
/// word to each other, by pwrite() to bytes that are theirs alone. That is safe on local disks and on the
/// parallel file systems of clusters (Lustre, GPFS, BeeGFS, CephFS), which are coherent; NFS is not, and is
/// refused where the ranks are on several hosts. The constructor, begin() and end() are collective, and throw
/// the same on all ranks.
class MeshFile final : public MeshSink {
public:
    /// @throw BadOption  as vdbtet::MeshFile; and for compressed files
    /// @throw FileError  where it cannot be written
    MeshFile(MPI_Comm comm, const std::string& path, const std::string& format = {},
             const FormatOptions& options = {});
    ~MeshFile() override;

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override { return true; }
    MeshWants wants() const override;

    /// @return the size in bytes of what end() has written
    std::uint64_t bytes() const;

    /// @return the names that the files have until end(): for those who must remove them in a signal handler.
    const std::vector<std::string>& temporaries() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet::mpi
