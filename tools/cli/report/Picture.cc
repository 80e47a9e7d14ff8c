/// @file Picture.cc
/// From fine to coarse until it fits.
#include "report/Picture.h"

#include <vdbtet/Errors.h>

#include <cmath>
#include <exception>

namespace {

/// A mesh turned out to be larger than can be shown.
struct TooMany : std::exception {};

/// Takes no larger mesh than it was told.
struct SmallMesh final : vdbtet::MeshSink {
    SmallMesh(vdbtet::TetMesh& to, std::int64_t most) : mesh(to), mostTets(most) {}

    bool begin(const vdbtet::MeshTotals& totals) override {
        if (totals.tets > mostTets) throw TooMany();
        return mesh.begin(totals);
    }
    void chunk(const vdbtet::MeshChunk& chunk) override { mesh.chunk(chunk); }
    void end() override { mesh.end(); }
    bool concurrent() const override { return mesh.concurrent(); }
    vdbtet::ChunkMemory memory(std::int64_t firstPoint, std::int64_t firstTet) override {
        return mesh.memory(firstPoint, firstTet);
    }

    vdbtet::TetMesh& mesh;
    std::int64_t mostTets;
};

} // namespace

Picture makePicture(const openvdb::GridBase& grid, const vdbtet::Options& options, const vdbtet::Report& of,
                    std::int64_t mostTets, openvdb::util::NullInterrupter* interrupter) {
    // A graded mesh of a solid has some seven tets a triangle; no use to try what has twice as many as may
    // be.
    constexpr double kTetsPerTriangle = 3.5;
    Picture picture;
    vdbtet::Options thin = options;
    thin.grade = true;
    thin.maxSize.reset();
    for (double factor = 1.0; factor < 1e6; factor *= 2.0) {
        const bool whole = factor == 1.0 && of.tets <= mostTets;
        const double expected = kTetsPerTriangle * double(of.boundaryTriangles) / (factor * factor);
        if (!whole && expected > double(mostTets)) continue;
        thin.spacing = factor * of.spacing;
        try {
            SmallMesh sink(picture.mesh, mostTets);
            picture.report = vdbtet::volumeToTets(grid, sink, whole ? options : thin, interrupter);
        } catch (const TooMany&) {
            continue;
        } catch (const vdbtet::Error& error) {
            picture.why = error.what();
            break;
        }
        if (!picture.report.cancelled) {
            picture.kind = whole           ? Picture::Kind::Whole
                           : factor == 1.0 ? Picture::Kind::SameSurface
                                           : Picture::Kind::Coarser;
        }
        return picture;
    }
    picture.mesh = {};
    return picture;
}
