/// @file SurfaceFile.h
/// Writes the boundary of a mesh as a triangle mesh.
#pragma once

#include <vdbtet/MeshSink.h>

#include <cstdint>
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
    /// @param splitsFans  make the surface a manifold where the mesh's is none, as Boundary::Fill and Raw
    /// may leave it: where the triangles at a point are more than one closed fan, each fan has a point of its
    /// own. The copies come last. In the order of the triangles all is as without.
    /// @throw BadOption where the extension is of no known format
    explicit SurfaceFile(const std::string& path, bool splitsFans = false);
    ~SurfaceFile() override;

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override { return true; }
    MeshWants wants() const override { return {true, false, false}; }

    /// @return how many points were added to split fans, after end()
    std::int64_t split() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
