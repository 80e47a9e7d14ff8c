/// @file MeshScaler.h
/// Changes the unit of a mesh.
#pragma once

#include <vdbtet/MeshSink.h>

#include <memory>

namespace vdbtet {

/// @brief Passes a mesh on to another sink with all coordinates times a factor: points, centroids, bounds.
/// @details Fields are passed on as they are. Rounding to float32, where MeshTotals::float32Suffices, may
/// turn an angle by up to 0.02 degrees here, as a factor moves coordinates to where float32 is coarser.
class MeshScaler final : public MeshSink {
public:
    /// @param next  gets the mesh; must outlive this
    /// @throw BadOption where @a factor is not positive and finite
    MeshScaler(MeshSink& next, double factor);
    ~MeshScaler() override;

    /// @throw TooLarge where float64 cannot hold the coordinates
    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override;
    MeshWants wants() const override;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
