/// @file Msh.cc
/// Gmsh's MSH 4.1, binary: one volume, of tag 1 and in the physical group 1, that has all points and all tets
/// as one block each. Ids and tags count from 1 and, being size_t, hold any mesh.
///
/// $Entities is optional, but the only place for a physical group, and DOLFINx takes no other tets. MuJoCo
/// wants the single blocks.
#include "io/formats/Format.h"
#include "io/formats/GmshFields.h"

#include <initializer_list>

namespace vdbtet {

namespace {

constexpr std::int32_t kVolume = 3, kTag = 1, kNotParametric = 0, kGmshTet = 4;

class Msh final : public Format {
public:
    explicit Msh(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    RecordLayout::Section mPointTags, mPoints, mTets;
    GmshFields mFields;
};

Msh::Msh(const MeshTotals& totals) {
    RecordLayout layout;
    const auto sizes = [&layout](std::initializer_list<std::int64_t> values) {
        for (const std::int64_t value : values) layout.binary(static_cast<std::uint64_t>(value));
    };
    const auto ints = [&layout](std::initializer_list<std::int32_t> values) {
        for (const std::int32_t value : values) layout.binary(value);
    };
    layout.text("$MeshFormat\n4.1 1 8\n");
    ints({1}); // tells the byte order
    layout.text("\n$EndMeshFormat\n$Entities\n");
    sizes({0, 0, 0, 1});
    ints({kTag});
    for (const openvdb::Vec3d& corner : {totals.bounds.min(), totals.bounds.max()})
        for (int axis = 0; axis < 3; ++axis) layout.binary(corner[axis]);
    sizes({1}); // physical group
    ints({kTag});
    sizes({0}); // bounding surfaces
    layout.text("\n$EndEntities\n$Nodes\n");
    sizes({1, totals.points, 1, totals.points});
    ints({kVolume, kTag, kNotParametric});
    sizes({totals.points});
    mPointTags = layout.records(totals.points, 8);
    mPoints = layout.records(totals.points, 3 * 8);
    layout.text("\n$EndNodes\n$Elements\n");
    sizes({1, totals.tets, 1, totals.tets});
    ints({kVolume, kTag, kGmshTet});
    sizes({totals.tets});
    mTets = layout.records(totals.tets, 5 * 8);
    layout.text("\n$EndElements\n");
    mFields.layOut(layout, totals, "msh");
    mLayouts.push_back(std::move(layout));
}

void Msh::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    RecordFile& file = files[0];
    file.put(mPointTags, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k) {
            const std::int64_t tag = chunk.firstPoint + std::int64_t(i + k) + 1;
            storeAs<std::uint64_t>(to + 8 * k, &tag, 1);
        }
    });
    file.put(mPoints, chunk.firstPoint, chunk.points.size(), [&](std::size_t i, std::size_t n, char* to) {
        storeAs<double>(to, chunk.points[i].asPointer(), 3 * n);
    });
    file.put(mTets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
        for (std::size_t k = 0; k < n; ++k, to += 5 * 8) {
            const Tet& tet = chunk.tets[i + k];
            const std::int64_t row[] = {chunk.firstTet + std::int64_t(i + k) + 1, tet[0] + 1, tet[1] + 1,
                                        tet[2] + 1, tet[3] + 1};
            storeAs<std::uint64_t>(to, row, 5);
        }
    });
    mFields.put(chunk, file);
}

} // namespace

std::unique_ptr<Format> makeMsh(const MeshTotals& totals) { return std::make_unique<Msh>(totals); }

} // namespace vdbtet
