/// @file VtuWriter.h
/// Streams a mesh into a VTK XML UnstructuredGrid file (.vtu).
#pragma once

#include <vdbtet/MeshSink.h>

#include <memory>
#include <string>

namespace vdbtet {

/// @brief Writes a .vtu with raw appended data (version 1.0, UInt64 headers) as ParaView reads it.
/// @details Coordinates are Float32 where MeshTotals::float32Suffices, else Float64; connectivity and offsets
/// are Int32 where they fit, else Int64. The file is written beside its target under a temporary name and
/// renamed by end(), so the target is always either the old file or the whole new one.
/// Every member throws FileError when the file cannot be written.
class VtuWriter final : public MeshSink {
public:
    explicit VtuWriter(std::string path);
    ~VtuWriter() override;

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override { return true; }

    /// @return the exact size in bytes of the file that a mesh of @a totals makes.
    static std::uint64_t fileSize(const MeshTotals& totals);

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
