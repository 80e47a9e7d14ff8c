/// @file VtkArrays.cc
/// Types, sizes and bytes of the arrays.
#include "io/formats/VtkArrays.h"

#include "io/formats/Format.h"

#include <limits>

namespace vdbtet {

namespace {

using Role = VtkArray::Role;

bool isOfPoints(Role role) { return role == Role::Points || role == Role::PointField; }

/// Put integers into an array of either width.
template <typename Value>
void storeIds(NumberType type, char* to, const Value* values, std::size_t count) {
    type == NumberType::Int32 ? storeAs<std::int32_t>(to, values, count)
                              : storeAs<std::int64_t>(to, values, count);
}

} // namespace

VtkArray::Run VtkArray::runOf(const MeshChunk& chunk) const {
    if (isOfPoints(role)) return {chunk.firstPoint, chunk.points.size()};
    return {chunk.firstTet, chunk.tets.size()};
}

void VtkArray::encode(const MeshChunk& chunk, std::size_t i, std::size_t n, char* to) const {
    switch (role) {
    case Role::Points: {
        const double* from = chunk.points[i].asPointer();
        type == NumberType::Float32 ? storeAs<float>(to, from, 3 * n) : storeAs<double>(to, from, 3 * n);
        break;
    }
    case Role::Connectivity:
        storeIds(type, to, chunk.tets[i].data(), 4 * n);
        break;
    case Role::Offsets:
        for (std::size_t k = 0; k < n; ++k) {
            const std::int64_t end = 4 * (chunk.firstTet + std::int64_t(i + k) + 1);
            storeIds(type, to + k * bytesOf(type), &end, 1);
        }
        break;
    case Role::Types:
        std::memset(to, kVtkTetra, n);
        break;
    case Role::PointField:
    case Role::CellField: {
        const auto& fields = role == Role::PointField ? chunk.pointFields : chunk.cellFields;
        std::memcpy(to, &fields[field][i * std::size_t(components)], n * recordBytes());
        break;
    }
    }
}

std::vector<VtkArray> vtkArrays(const MeshTotals& totals) {
    constexpr std::int64_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();
    const NumberType real = totals.float32Suffices ? NumberType::Float32 : NumberType::Float64;
    const bool fits = totals.points - 1 <= kMaxInt32 && totals.tets <= kMaxInt32 / 4;
    const NumberType id = fits ? NumberType::Int32 : NumberType::Int64;
    std::vector<VtkArray> arrays = {{Role::Points, "", real, 3, totals.points},
                                    {Role::Connectivity, "", id, 4, totals.tets},
                                    {Role::Offsets, "", id, 1, totals.tets},
                                    {Role::Types, "", NumberType::UInt8, 1, totals.tets}};
    const auto add = [&arrays](Role role, const std::vector<MeshField>& fields, std::int64_t records) {
        for (std::size_t i = 0; i < fields.size(); ++i) {
            arrays.push_back({role, fields[i].name, NumberType::Float32, fields[i].components, records, i});
        }
    };
    add(Role::PointField, totals.pointFields, totals.points);
    add(Role::CellField, totals.cellFields, totals.tets);
    return arrays;
}

} // namespace vdbtet
