/// @file TetMesh.cc
/// The in-memory mesh as a sink.
#include <vdbtet/TetMesh.h>

namespace vdbtet {

bool TetMesh::begin(const MeshTotals& totals) {
    points.clear();
    tets.clear();
    points.reserve(static_cast<std::size_t>(totals.points));
    tets.reserve(static_cast<std::size_t>(totals.tets));
    return true;
}

void TetMesh::chunk(const MeshChunk& chunk) {
    points.insert(points.end(), chunk.points.begin(), chunk.points.end());
    tets.insert(tets.end(), chunk.tets.begin(), chunk.tets.end());
}

} // namespace vdbtet
