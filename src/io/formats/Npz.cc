/// @file Npz.cc
/// NumPy's .npz: an archive of the arrays `vertices` and `tet_indices`, as Newton and Warp load them, and of
/// `point_NAME` and `cell_NAME` for each field.
#include "io/formats/Format.h"
#include "io/formats/Names.h"
#include "io/formats/StoredZip.h"

#include <limits>

namespace vdbtet {

namespace {

/// The header of an array in a file of its own; of one dimension for one column.
std::string npyHeader(char kind, std::size_t itemBytes, std::int64_t rows, int columns) {
    const char order = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? '>' : '<';
    std::string header = std::string("{'descr': '") + order + kind + std::to_string(itemBytes) +
                         "', 'fortran_order': False, 'shape': (" + std::to_string(rows) + "," +
                         (columns == 1 ? "" : " " + std::to_string(columns)) + "), }";
    const std::size_t before = 10; // bytes of magic, version and length; all of it is a multiple of 64
    header.append(63 - (before + header.size()) % 64, ' ').append("\n");
    return "\x93NUMPY" + littleEndian({{1, 1}, {0, 1}, {header.size(), 2}}) + header;
}

class Npz final : public Format {
public:
    explicit Npz(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;
    std::vector<std::uint32_t> checksums() const override { return mZip.crcs(); }
    void finish(std::deque<RecordFile>& files, const std::vector<std::uint32_t>& crcs) const override {
        mZip.writeCrcs(files[0], crcs);
    }

private:
    bool mFloat32, mInt32;
    StoredZip mZip;
    StoredZip::Entry *mPoints, *mTets;
    FieldPlaces<StoredZip::Entry*> mFields;
};

Npz::Npz(const MeshTotals& totals)
    : mFloat32(totals.float32Suffices),
      mInt32(totals.points - 1 <= std::numeric_limits<std::int32_t>::max()) {
    const std::size_t realBytes = mFloat32 ? 4 : 8, idBytes = mInt32 ? 4 : 8;
    RecordLayout layout;
    mPoints = &mZip.append(layout, "vertices.npy", npyHeader('f', realBytes, totals.points, 3), totals.points,
                           3 * realBytes);
    mTets = &mZip.append(layout, "tet_indices.npy", npyHeader('i', idBytes, totals.tets, 4), totals.tets,
                         4 * idBytes);
    UniqueNames unique;
    const auto entries = [&](const std::string& prefix, const std::vector<MeshField>& fields,
                             std::int64_t records) {
        std::vector<StoredZip::Entry*> places;
        for (const MeshField& field : fields) {
            places.push_back(&mZip.append(layout, unique(prefix + fileName(field.name)) + ".npy",
                                          npyHeader('f', 4, records, field.components), records,
                                          4 * std::size_t(field.components)));
        }
        return places;
    };
    mFields.points = entries("point_", totals.pointFields, totals.points);
    mFields.cells = entries("cell_", totals.cellFields, totals.tets);
    mZip.appendDirectory(layout);
    mLayouts.push_back(std::move(layout));
}

void Npz::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    StoredZip::put(files[0], *mPoints, chunk.firstPoint, chunk.points.size(),
                   [&](std::size_t i, std::size_t n, char* to) {
                       const double* from = chunk.points[i].asPointer();
                       mFloat32 ? storeAs<float>(to, from, 3 * n) : storeAs<double>(to, from, 3 * n);
                   });
    StoredZip::put(
        files[0], *mTets, chunk.firstTet, chunk.tets.size(), [&](std::size_t i, std::size_t n, char* to) {
            const std::int64_t* from = chunk.tets[i].data();
            mInt32 ? storeAs<std::int32_t>(to, from, 4 * n) : storeAs<std::int64_t>(to, from, 4 * n);
        });
    mFields.forEach(chunk, [&files](StoredZip::Entry* entry, std::int64_t first, std::size_t count,
                                    const ArrayView<float>& values) {
        const std::size_t components = entry->records.recordBytes / 4;
        StoredZip::put(files[0], *entry, first, count, [&](std::size_t i, std::size_t n, char* to) {
            storeAs<float>(to, &values[i * components], n * components);
        });
    });
}

} // namespace

std::unique_ptr<Format> makeNpz(const MeshTotals& totals) { return std::make_unique<Npz>(totals); }

} // namespace vdbtet
