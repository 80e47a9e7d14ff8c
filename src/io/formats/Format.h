/// @file Format.h
/// What a mesh looks like in files of one format.
#pragma once

#include "io/RecordFile.h"

#include <vdbtet/MeshSink.h>

#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace vdbtet {

/// A mesh of known size in one format: made by MakeFormat, which lays its files out.
class Format {
public:
    virtual ~Format() = default;

    /// Write a chunk into @a files, one for each layout; called by several threads at once.
    virtual void write(const MeshChunk& chunk, std::deque<RecordFile>& files) const = 0;

    /// Write what is known only now that every chunk is written.
    virtual void finish(std::deque<RecordFile>& files) const { static_cast<void>(files); }

    const std::vector<RecordLayout>& layouts() const { return mLayouts; }
    bool wantsTriangles() const { return mWantsTriangles; }
    /// Whether MeshTotals::pointFields are written.
    bool holdsFields() const { return mHoldsFields; }

protected:
    std::vector<RecordLayout> mLayouts;
    bool mWantsTriangles = false;
    bool mHoldsFields = false;
};

/// @throw TooLarge where the format cannot hold a mesh of that size
using MakeFormat = std::unique_ptr<Format> (*)(const MeshTotals& totals);

std::unique_ptr<Format> makeMesh(const MeshTotals& totals);
std::unique_ptr<Format> makeMeshb(const MeshTotals& totals);
std::unique_ptr<Format> makeMsh(const MeshTotals& totals);
std::unique_ptr<Format> makeMsh22(const MeshTotals& totals);
std::unique_ptr<Format> makeVtk(const MeshTotals& totals);
std::unique_ptr<Format> makeVtu(const MeshTotals& totals);
std::unique_ptr<Format> makeVtuInline(const MeshTotals& totals);
std::unique_ptr<Format> makeTetGen(const MeshTotals& totals);
std::unique_ptr<Format> makeNpz(const MeshTotals& totals);
std::unique_ptr<Format> makeInp(const MeshTotals& totals);
std::unique_ptr<Format> makeGeo(const MeshTotals& totals);
std::unique_ptr<Format> makeUsda(const MeshTotals& totals);

/// Put numbers into a record, as @a T.
template <typename T, typename Value>
void storeAs(char* to, const Value* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const T value = static_cast<T>(values[i]);
        std::memcpy(to + i * sizeof(T), &value, sizeof(T));
    }
}

/// Write the values of a field as they are in memory, for a section that has a record for each point.
inline void putField(RecordFile& file, const RecordLayout::Section& section, std::int64_t firstPoint,
                     std::size_t points, const ArrayView<float>& values) {
    const std::size_t components = section.recordBytes / sizeof(float);
    file.put(section, firstPoint, points, [&](std::size_t i, std::size_t n, char* to) {
        std::memcpy(to, &values[i * components], n * section.recordBytes);
    });
}

} // namespace vdbtet
