/// @file FieldSampler.h
/// Carries the values of grids over to the points of a mesh.
#pragma once

#include <vdbtet/MeshSink.h>

#include <openvdb/Grid.h>

#include <memory>
#include <vector>

namespace vdbtet {

/// @brief Passes a mesh on to another sink, together with the values of grids at its points.
/// @details Trilinear, at the world position of each point, each grid by its own transform. Grids of float,
/// double, int32, int64 and of vectors of three of these. Components of a staggered velocity are where they
/// are stored: on the faces of voxels. Vectors are not transformed. Values are float32.
class FieldSampler final : public MeshSink {
public:
    /// @param next   gets the mesh; must outlive this
    /// @param grids  named after their grids; an unnamed one is called "field"
    /// @throw UnsupportedGrid for other types of grids
    FieldSampler(MeshSink& next, const std::vector<openvdb::GridBase::ConstPtr>& grids);
    ~FieldSampler() override;

    /// Whether a grid is of a type that can be sampled.
    static bool canSample(const openvdb::GridBase& grid);

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override;
    MeshWants wants() const override;
    ChunkMemory memory(std::int64_t firstPoint, std::int64_t firstTet) override;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
