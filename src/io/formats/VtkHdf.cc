/// @file VtkHdf.cc
/// VTKHDF with arrays in one piece each, of which the HDF5 library tells the place: all that it writes itself
/// is a text between the records.
#include "io/formats/Format.h"
#include "io/formats/VtkHdfSchema.h"

namespace vdbtet {

namespace {

class VtkHdf final : public Format {
public:
    explicit VtkHdf(const MeshTotals& totals);

    void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const override;

private:
    std::vector<std::pair<VtkArray, RecordLayout::Section>> mArrays;
};

VtkHdf::VtkHdf(const MeshTotals& totals) {
    Hdf5Image image;
    Hdf5File file(image, "a VTKHDF file");
    for (const VtkHdfArray& added : addVtkHdf(file, totals, 0)) {
        RecordLayout::Section section{file.offsetOf(added.id, added.shape), added.array.recordBytes()};
        if (added.array.role == VtkArray::Role::Offsets) {
            // The first tet starts at 0; what follows is where tets end.
            const std::string zero(section.recordBytes, '\0');
            image.write(section.offset, zero.data(), zero.size());
            section.offset += section.recordBytes;
        }
        mArrays.emplace_back(added.array, section);
    }
    const std::uint64_t size = file.close();
    mLayouts.emplace_back(image.pieces(size), size);
}

void VtkHdf::write(const MeshChunk& chunk, std::deque<RecordFile>& files) const {
    for (const auto& [array, section] : mArrays) {
        const VtkArray::Run run = array.runOf(chunk);
        files[0].put(section, run.first, run.count,
                     [&chunk, &array = array](std::size_t i, std::size_t n, char* to) {
                         array.encode(chunk, i, n, to);
                     });
    }
}

} // namespace

std::unique_ptr<Format> makeVtkHdf(const MeshTotals& totals) { return std::make_unique<VtkHdf>(totals); }

} // namespace vdbtet
