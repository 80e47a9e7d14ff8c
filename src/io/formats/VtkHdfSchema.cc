/// @file VtkHdfSchema.cc
/// Names and shapes.
#include "io/formats/VtkHdfSchema.h"

#include "io/formats/Names.h"

#include <algorithm>
#include <set>

namespace vdbtet {

namespace {

using Role = VtkArray::Role;

/// Of arrays that are no fields, by role.
constexpr const char* kNames[] = {"Points", "Connectivity", "Offsets", "Types"};

/// Names in the groups of fields, which are without slashes and all different.
class LinkNames {
public:
    std::string operator()(const VtkArray& array) {
        std::string name = fileName(array.name);
        if (name == "." || name == "..") name += "_";
        while (!mTaken.emplace(array.role, name).second) name += "_";
        return name;
    }

private:
    std::set<std::pair<Role, std::string>> mTaken;
};

} // namespace

std::vector<VtkHdfArray> addVtkHdf(Hdf5File& file, const MeshTotals& totals, std::size_t chunkBytes) {
    const Hdf5File::Id root = file.addGroup("VTKHDF");
    file.addAttribute(root, "Version", std::vector<std::int64_t>{1, 0});
    file.addAttribute(root, "Type", "UnstructuredGrid");
    file.addNumber(root, "NumberOfPoints", totals.points);
    file.addNumber(root, "NumberOfCells", totals.tets);
    file.addNumber(root, "NumberOfConnectivityIds", 4 * totals.tets);
    const Hdf5File::Id pointData = totals.pointFields.empty() ? root : file.addGroup("PointData", root);
    const Hdf5File::Id cellData = totals.cellFields.empty() ? root : file.addGroup("CellData", root);

    LinkNames linkName;
    std::vector<VtkHdfArray> arrays;
    for (const VtkArray& array : vtkArrays(totals)) {
        const auto records = std::uint64_t(array.records), numbers = std::uint64_t(array.components);
        const bool isField = array.role == Role::PointField || array.role == Role::CellField;
        const Hdf5File::Id group = array.role == Role::PointField  ? pointData
                                   : array.role == Role::CellField ? cellData
                                                                   : root;
        VtkHdfArray added{array, {}, 0, array.role == Role::Connectivity ? 1 : numbers};
        Hdf5Array& shape = added.shape;
        shape.name = isField ? linkName(array) : kNames[int(array.role)];
        shape.type = array.type;
        shape.extent = {records * added.rowsARecord() + (array.role == Role::Offsets ? 1 : 0)};
        if (added.numbersARow > 1) shape.extent.push_back(numbers);
        // HDF5 wants no chunk to be larger than its array.
        shape.chunkRows = std::min(chunkBytes / array.recordBytes() * added.rowsARecord(), shape.extent[0]);
        shape.shuffled = bytesOf(array.type) > 1;
        added.id = file.addArray(group, shape);
        arrays.push_back(std::move(added));
    }
    return arrays;
}

} // namespace vdbtet
