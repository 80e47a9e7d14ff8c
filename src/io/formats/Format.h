/// @file Format.h
/// What a mesh looks like in files of one format.
#pragma once

#include "io/RecordFile.h"

#include <vdbtet/MeshFile.h>

#include <cstdint>
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

    /// @return checksums of the records written; where several processes write one file, those of the file
    /// are theirs XORed
    virtual std::vector<std::uint32_t> checksums() const { return {}; }

    /// Write what is known only now that every chunk is written.
    /// @param checksums  of the file
    virtual void finish(std::deque<RecordFile>& files, const std::vector<std::uint32_t>& checksums) const {
        static_cast<void>(files);
        static_cast<void>(checksums);
    }

    const std::vector<RecordLayout>& layouts() const { return mLayouts; }
    bool wantsTriangles() const { return mWantsTriangles; }

protected:
    std::vector<RecordLayout> mLayouts;
    bool mWantsTriangles = false;
};

/// @throw TooLarge where the format cannot hold a mesh of that size
using MakeFormat = std::unique_ptr<Format> (*)(const MeshTotals& totals);

std::unique_ptr<Format> makeMesh(const MeshTotals& totals);
std::unique_ptr<Format> makeMeshb(const MeshTotals& totals);
std::unique_ptr<Format> makeMsh(const MeshTotals& totals);
std::unique_ptr<Format> makeMsh22(const MeshTotals& totals);
std::unique_ptr<Format> makeVtk(const MeshTotals& totals);
std::unique_ptr<Format> makeVtkHdf(const MeshTotals& totals);
std::unique_ptr<Format> makeVtu(const MeshTotals& totals);
std::unique_ptr<Format> makeVtuInline(const MeshTotals& totals);
std::unique_ptr<Format> makeTetGen(const MeshTotals& totals);
std::unique_ptr<Format> makeNpz(const MeshTotals& totals);
std::unique_ptr<Format> makeInp(const MeshTotals& totals);
std::unique_ptr<Format> makeGeo(const MeshTotals& totals);
std::unique_ptr<Format> makeUsda(const MeshTotals& totals, const UsdOptions& options);

/// Lay a mesh out in a format by its name or by the path's extension.
/// @throw BadOption, TooLarge, FileError as MeshFile::begin()
std::unique_ptr<const Format> makeFormat(const std::string& path, const std::string& name,
                                         const MeshTotals& totals, const FormatOptions& options);

/// Put numbers into a record, as @a T.
template <typename T, typename Value>
void storeAs(char* to, const Value* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const T value = static_cast<T>(values[i]);
        std::memcpy(to + i * sizeof(T), &value, sizeof(T));
    }
}

/// Where the values of fields go.
template <typename Place>
struct FieldPlaces {
    std::vector<Place> points, cells; ///< by field

    /// Call @a visit(place, first, count, values) for each field, of the records first, first + 1, ...
    template <typename Visit>
    void forEach(const MeshChunk& chunk, const Visit& visit) const {
        for (std::size_t f = 0; f < points.size(); ++f)
            visit(points[f], chunk.firstPoint, chunk.points.size(), chunk.pointFields[f]);
        for (std::size_t f = 0; f < cells.size(); ++f)
            visit(cells[f], chunk.firstTet, chunk.tets.size(), chunk.cellFields[f]);
    }
};

} // namespace vdbtet
