/// @file mpi/PvtuFile.h
/// A file a rank, and one that names them.
#pragma once

#include <vdbtet/MeshSink.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbtet::mpi {

/// @brief Writes OUT.pvtu, and for each rank OUT_0.vtu, OUT_1.vtu, ... beside it: for file systems where
/// ranks may not write one file together, and for readers that are parallel.
/// @details A piece has its rank's tets, and their points: those that are the rank's own, in ascending order
/// of their ids, then those of others, which vtkGhostType marks as duplicates. GlobalPointIds are the ids of
/// the mesh of one rank. A rank spools its part to the disk, twice the size of its piece, before it writes
/// that. Pieces are renamed when all are whole, and OUT.pvtu last. The constructor, begin() and end() are
/// collective, and throw the same on all ranks.
class PvtuFile final : public MeshSink {
public:
    /// @param path  ends in .pvtu
    /// @throw FileError where it cannot be written
    PvtuFile(MPI_Comm comm, const std::string& path);
    ~PvtuFile() override;

    /// @throw BadOption where there are fields
    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;

    /// @return the size in bytes of all that end() has written
    std::uint64_t bytes() const;

    /// @return the names that this rank's files have until end(), if any; see MeshFile::temporaries()
    std::vector<std::string> temporaries() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet::mpi
