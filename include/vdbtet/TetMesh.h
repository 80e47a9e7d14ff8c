/// @file TetMesh.h
/// A tetrahedral mesh in memory.
#pragma once

#include <vdbtet/MeshSink.h>

#include <vector>

namespace vdbtet {

/// @brief A whole mesh in memory, itself a sink: pass it to volumeToTets().
/// @details It can be filled again, and then uses the memory it has. A run that is cancelled or throws leaves
/// it with arbitrary points and tets.
struct TetMesh final : MeshSink {
    std::vector<openvdb::Vec3d> points; ///< world space
    std::vector<Tet> tets;              ///< indices into points, positively oriented

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override {}
    bool concurrent() const override { return true; }
    ChunkMemory memory(std::int64_t firstPoint, std::int64_t firstTet) override;
};

} // namespace vdbtet
