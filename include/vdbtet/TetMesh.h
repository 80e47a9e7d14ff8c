/// @file TetMesh.h
/// A tetrahedral mesh in memory.
#pragma once

#include <vdbtet/MeshSink.h>

namespace vdbtet {

/// @brief A whole mesh in memory, itself a sink: pass it to volumeToTets().
/// @details A run that is cancelled or throws leaves it partly filled; begin() clears it.
struct TetMesh final : MeshSink {
    std::vector<openvdb::Vec3d> points; ///< world space
    std::vector<Tet> tets;              ///< indices into points, positively oriented

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override {}
};

} // namespace vdbtet
