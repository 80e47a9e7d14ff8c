/// @file TetMesh.cc
/// The in-memory mesh as a sink.
#include <vdbtet/TetMesh.h>

namespace vdbtet {

bool TetMesh::begin(const MeshTotals& totals) {
    points.resize(static_cast<std::size_t>(totals.points));
    tets.resize(static_cast<std::size_t>(totals.tets));
    return true;
}

ChunkMemory TetMesh::memory(std::int64_t firstPoint, std::int64_t firstTet) {
    return {points.data() + firstPoint, tets.data() + firstTet};
}

} // namespace vdbtet
