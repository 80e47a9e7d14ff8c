/// @file FieldSampler.h
/// Carries the values of grids over to the points and tets of a mesh.
#pragma once

#include <vdbtet/MeshSink.h>

#include <openvdb/Grid.h>

#include <memory>
#include <vector>

namespace vdbtet {

/// What a FieldSampler adds to a mesh. Fields have the names of their grids, "field" for an unnamed one; the
/// later of two of a name gets a "_" behind it.
struct FieldOptions {
    std::vector<openvdb::GridBase::ConstPtr> pointGrids; ///< sampled at the points; see signedDistance(), too
    std::vector<openvdb::GridBase::ConstPtr> cellGrids;  ///< sampled at the centroids of the tets
    /// Point field "boundary": 1 on the surface, else 0. Where the lattice does not resolve the surface, a
    /// few of its points have tets all around them.
    bool boundaryFlag = false;
    bool minDihedral = false; ///< cell field "min_dihedral": each tet's smallest dihedral angle, degrees
};

/// @brief Passes a mesh on to another sink, together with the values of grids at its points and in its tets.
/// @details Trilinear, at the world position of each point or centroid, each grid by its own transform. Grids
/// of float, double, int32, int64 and of vectors of three of these. Components of a staggered velocity are
/// where they are stored: on the faces of voxels. Vectors are not transformed. Values are float32.
class FieldSampler final : public MeshSink {
public:
    /// @param next  gets the mesh; must outlive this
    /// @throw UnsupportedGrid for other types of grids
    FieldSampler(MeshSink& next, const FieldOptions& fields);
    /// Of grids at the points.
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
