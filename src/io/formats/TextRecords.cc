/// @file TextRecords.cc
/// Numbers to text by std::to_chars(), which knows no locale.
#include "io/formats/TextRecords.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <type_traits>

namespace vdbtet {

namespace {

/// Signs, the point and the exponent are what a number takes besides its digits.
constexpr std::size_t kFloatWidth = std::numeric_limits<float>::max_digits10 + sizeof("-.e-38") - 1;
constexpr std::size_t kDoubleWidth = std::numeric_limits<double>::max_digits10 + sizeof("-.e-308") - 1;

char* alignRight(char* to, const char* digits, std::size_t count, std::size_t width) {
    std::memset(to, ' ', width - count);
    std::memcpy(to + width - count, digits, count);
    return to + width;
}

char* writeId(char* to, std::int64_t id, std::size_t width) {
    char digits[std::numeric_limits<std::int64_t>::digits10 + 2];
    const char* end = std::to_chars(digits, std::end(digits), id).ptr;
    return alignRight(to, digits, std::size_t(end - digits), width);
}

template <typename Real>
char* writeReal(char* to, Real value, std::size_t width) {
    char digits[kDoubleWidth];
    // The shortest text of a float may become its neighbour by way of a double, that of nine digits does not.
    const char* end = std::is_same_v<Real, float>
                          ? std::to_chars(digits, std::end(digits), value, std::chars_format::general,
                                          std::numeric_limits<float>::max_digits10)
                                .ptr
                          : std::to_chars(digits, std::end(digits), value).ptr;
    // A format with narrow columns gets fewer digits of the numbers that need an exponent.
    for (int precision = std::numeric_limits<Real>::max_digits10; std::size_t(end - digits) > width;
         --precision)
        end = std::to_chars(digits, std::end(digits), value, std::chars_format::general, precision).ptr;
    return alignRight(to, digits, std::size_t(end - digits), width);
}

} // namespace

TextNumbers::TextNumbers(const MeshTotals& totals, std::int64_t idOfFirst) : firstId(idOfFirst) {
    const std::int64_t most = std::max({totals.points, totals.tets, totals.triangles, std::int64_t(1)});
    idWidth = std::to_string(idOfFirst + most - 1).size();
    useFloat32(totals.float32Suffices);
}

void TextNumbers::useFloat32(bool use) {
    float32 = use;
    realWidth = use ? kFloatWidth : kDoubleWidth;
}

TextRows::TextRows(RecordLayout& layout, std::int64_t count, const std::string& pattern,
                   const TextNumbers& numbers)
    : mPattern(pattern), mNumbers(numbers) {
    std::size_t bytes = 0;
    for (const char c : pattern)
        bytes += c == '*'               ? numbers.realWidth
                 : c == '~'             ? kFloatWidth
                 : c == '#' || c == '@' ? numbers.idWidth
                                        : 1;
    mSection = layout.records(count, bytes);
}

char* TextRows::write(char* to, std::int64_t number, const Row& row, const float* values) const {
    const std::int64_t* id = row.ids;
    int axis = 0;
    for (const char c : mPattern) {
        if (c == '@') {
            to = writeId(to, mNumbers.firstId + number, mNumbers.idWidth);
        } else if (c == '#') {
            to = writeId(to, mNumbers.firstId + *id++, mNumbers.idWidth);
        } else if (c == '*') {
            const double x = row.coordinates[axis] - mNumbers.origin[axis];
            ++axis;
            to = mNumbers.float32 ? writeReal(to, float(x), mNumbers.realWidth)
                                  : writeReal(to, x, mNumbers.realWidth);
        } else if (c == '~') {
            to = writeReal(to, *values++, kFloatWidth);
        } else {
            *to++ = c;
        }
    }
    return to;
}

template <typename RowAt>
void TextRows::putRows(RecordFile& file, std::int64_t first, std::size_t count,
                       const std::vector<ArrayView<float>>& fields, const RowAt& rowAt) const {
    file.put(mSection, first, count, [&](std::size_t i, std::size_t n, char* to) {
        const bool startsSection = first + std::int64_t(i) == 0;
        char* end = to;
        std::vector<float> values;
        for (std::size_t k = i; k < i + n; ++k) {
            values.clear();
            for (const ArrayView<float>& field : fields) {
                const std::size_t components = field.size() / count;
                values.insert(values.end(), &field[k * components], &field[k * components] + components);
            }
            end = write(end, first + std::int64_t(k), rowAt(k), values.data());
        }
        if (startsSection && *to == ',') *to = ' ';
    });
}

void TextRows::put(RecordFile& file, std::int64_t first, const ArrayView<openvdb::Vec3d>& points,
                   const std::vector<ArrayView<float>>& fields) const {
    putRows(file, first, points.size(), fields, [&](std::size_t k) {
        return Row{points[k].asPointer(), nullptr};
    });
}
void TextRows::put(RecordFile& file, std::int64_t first, const ArrayView<Tet>& tets,
                   const std::vector<ArrayView<float>>& fields) const {
    putRows(file, first, tets.size(), fields, [&](std::size_t k) { return Row{nullptr, tets[k].data()}; });
}
void TextRows::put(RecordFile& file, std::int64_t first, const ArrayView<Triangle>& triangles) const {
    putRows(file, first, triangles.size(), {}, [&](std::size_t k) {
        return Row{nullptr, triangles[k].data()};
    });
}
void TextRows::put(RecordFile& file, std::int64_t first, std::size_t count,
                   const ArrayView<float>& values) const {
    putRows(file, first, count, {values}, [](std::size_t) { return Row{nullptr, nullptr}; });
}

template <typename Real>
std::string shortest(Real value) {
    char digits[kDoubleWidth];
    return {digits, std::to_chars(digits, std::end(digits), value).ptr};
}
template std::string shortest(float);
template std::string shortest(double);

void requireAtMost(std::int64_t most, std::int64_t count, const char* what, const char* format) {
    if (count <= most) return;
    throw TooLarge("the mesh has " + std::to_string(count) + " " + what + ", but the format " + format +
                   " numbers no more than " + std::to_string(most) + "; write it as vtu");
}

} // namespace vdbtet
