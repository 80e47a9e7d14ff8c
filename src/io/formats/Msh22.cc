/// @file Msh22.cc
/// Gmsh's MSH 2.2, binary: ids and tags are int32 and count from 1, and each tet is of the physical and the
/// elementary volume 1, as readers want both tags.
///
/// A header may stand for many tets, but Gmsh writes one for each, and MuJoCo reads no other files.
#include "io/formats/Format.h"
#include "io/formats/GmshFields.h"

#include <vdbtet/Errors.h>

#include <limits>

namespace vdbtet {

namespace {

constexpr std::int64_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t kGmshTet = 4, kTag = 1;
constexpr std::size_t kPointBytes = 4 + 3 * 8, kTetInts = 10;

class Msh22 final : public Format {
public:
    explicit Msh22(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    RecordLayout::Section mPoints, mTets;
    GmshFields mFields;
};

Msh22::Msh22(const MeshTotals& totals) {
    if (totals.points > kMaxInt32 || totals.tets > kMaxInt32) {
        throw TooLarge("the format msh22 holds " + std::to_string(kMaxInt32) +
                       " points and as many tets, and the mesh has " + std::to_string(totals.points) +
                       " and " + std::to_string(totals.tets) + "; msh, vtu and vtk hold it");
    }
    RecordLayout layout;
    layout.text("$MeshFormat\n2.2 1 8\n");
    layout.binary(std::int32_t(1)); // tells the byte order
    layout.text("\n$EndMeshFormat\n$Nodes\n" + std::to_string(totals.points) + "\n");
    mPoints = layout.records(totals.points, kPointBytes);
    layout.text("\n$EndNodes\n$Elements\n" + std::to_string(totals.tets) + "\n");
    mTets = layout.records(totals.tets, kTetInts * 4);
    layout.text("\n$EndElements\n");
    mFields.layOut(layout, totals, "msh22");
    mLayouts.push_back(std::move(layout));
}

void Msh22::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k, to += kPointBytes) {
            const std::int64_t id = chunk.firstPoint + std::int64_t(i + k) + 1;
            storeAs<std::int32_t>(to, &id, 1);
            storeAs<double>(to + 4, chunk.points[i + k].asPointer(), 3);
        }
    });
    file.put(mTets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k, to += kTetInts * 4) {
            const Tet& tet = chunk.tets[i + k];
            const std::int64_t id = chunk.firstTet + std::int64_t(i + k) + 1;
            const std::int64_t ints[kTetInts] = {kGmshTet, 1,          2,          id,         kTag,
                                                 kTag,     tet[0] + 1, tet[1] + 1, tet[2] + 1, tet[3] + 1};
            storeAs<std::int32_t>(to, ints, kTetInts);
        }
    });
    mFields.put(chunk, file);
}

} // namespace

std::unique_ptr<Format> makeMsh22(const MeshTotals& totals) { return std::make_unique<Msh22>(totals); }

} // namespace vdbtet
