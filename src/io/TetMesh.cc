/// @file TetMesh.cc
/// The in-memory mesh as a sink.
#include <vdbtet/TetMesh.h>

#include <algorithm>

namespace vdbtet {

bool TetMesh::begin(const MeshTotals& totals) {
    points.resize(static_cast<std::size_t>(totals.points));
    tets.resize(static_cast<std::size_t>(totals.tets));
    return true;
}

void TetMesh::chunk(const MeshChunk& chunk) {
    const ChunkMemory own = memory(chunk.firstPoint, chunk.firstTet);
    if (chunk.points.data() != own.points) std::copy(chunk.points.begin(), chunk.points.end(), own.points);
    if (chunk.tets.data() != own.tets) std::copy(chunk.tets.begin(), chunk.tets.end(), own.tets);
}

ChunkMemory TetMesh::memory(std::int64_t firstPoint, std::int64_t firstTet) {
    return {points.data() + firstPoint, tets.data() + firstTet};
}

} // namespace vdbtet
