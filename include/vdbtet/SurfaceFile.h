/// @file SurfaceFile.h
/// Writes the boundary of a mesh as a triangle mesh.
#pragma once

#include <vdbtet/MeshSink.h>

#include <memory>
#include <string>

namespace vdbtet {

/// @brief Writes the boundary triangles, and the points they use, into an .obj, .ply or .stl file.
/// @details Triangles are counter-clockwise seen from outside; points are in the order of the mesh. The .ply
/// is binary, with coordinates as float32 where MeshTotals::float32Suffices, else as float64; the .stl is
/// binary and always float32; the .obj has as many digits as the numbers need. The boundary is kept in memory
/// until end(). Files are written and renamed as MeshFile's are. Every member throws
/// FileError when the file cannot be written, and begin() throws TooLarge for more points or triangles than
/// the format can count.
class SurfaceFile final : public MeshSink {
public:
    /// @throw BadOption where the extension is of no known format
    explicit SurfaceFile(const std::string& path);
    ~SurfaceFile() override;

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override { return true; }
    MeshWants wants() const override { return {true, false, false}; }

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
