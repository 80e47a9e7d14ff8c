/// @file Piece.cc
/// Two passes over the tets: the points of others, then local numbers.
#include "mpi/Piece.h"

#include <vdbtet/MeshSink.h>

#include <algorithm>

namespace vdbtet::mpi {

namespace {

constexpr std::int64_t kBatch = std::int64_t(1) << 16; ///< records

/// Call @a visit(records, count) for the records of a spool, a batch at a time.
template <typename T, typename Visit>
void forEachBatch(const SpoolFile& spool, std::int64_t count, const Visit& visit) {
    std::vector<T> batch;
    for (std::int64_t done = 0; done < count; done += kBatch) {
        batch.resize(std::size_t(std::min(kBatch, count - done)));
        spool.readAt(std::uint64_t(done) * sizeof(T), batch.data(), batch.size() * sizeof(T));
        visit(batch);
    }
}

void sortUnique(std::vector<std::int64_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Writes one array behind the other, each after its size.
class Appender {
public:
    Appender(OutputFile& file, std::uint64_t at) : mFile(file), mAt(at) {}

    void begin(std::uint64_t bytes) { add(&bytes, 1); }
    template <typename T>
    void add(const T* values, std::size_t count) {
        mFile.writeAt(mAt, values, count * sizeof(T));
        mAt += count * sizeof(T);
    }
    /// Values number 0, 1, ... of @a count.
    template <typename T, typename Value>
    void addEach(std::int64_t count, const Value& value) {
        std::vector<T> batch;
        for (std::int64_t done = 0; done < count; done += kBatch) {
            batch.clear();
            for (std::int64_t i = done; i < std::min(count, done + kBatch); ++i) batch.push_back(value(i));
            add(batch.data(), batch.size());
        }
    }
    std::uint64_t at() const { return mAt; }

private:
    OutputFile& mFile;
    std::uint64_t mAt;
};

template <typename T>
void addPlaces(Appender& out, const std::vector<openvdb::Vec3d>& places) {
    std::vector<T> values;
    for (const openvdb::Vec3d& place : places) {
        for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<T>(place[axis]));
    }
    out.add(values.data(), values.size());
}

/// The text before the arrays, with the place of each.
std::string header(std::int64_t points, std::int64_t tets, bool float32) {
    const auto p = std::uint64_t(points), t = std::uint64_t(tets);
    std::uint64_t at = 0;
    const auto array = [&](const char* type, const char* name, const char* more, std::uint64_t bytes) {
        const std::string text = std::string("        <DataArray type=\"") + type + "\" Name=\"" + name +
                                 "\"" + more + " format=\"appended\" offset=\"" + std::to_string(at) +
                                 "\"/>\n";
        at += 8 + bytes;
        return text;
    };
    std::string text = std::string("<?xml version=\"1.0\"?>\n"
                                   "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
                       byteOrder() +
                       "\" header_type=\"UInt64\">\n"
                       "  <UnstructuredGrid>\n"
                       "    <Piece NumberOfPoints=\"" +
                       std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(tets) + "\">\n";
    text += "      <Points>\n";
    text += array(float32 ? "Float32" : "Float64", "Points", " NumberOfComponents=\"3\"",
                  3 * p * (float32 ? 4 : 8));
    text += "      </Points>\n      <PointData GlobalIds=\"GlobalPointIds\">\n";
    text += array("Int64", "GlobalPointIds", "", 8 * p);
    text += array("UInt8", "vtkGhostType", "", p);
    text += "      </PointData>\n      <Cells>\n";
    text += array("Int64", "connectivity", "", 32 * t);
    text += array("Int64", "offsets", "", 8 * t);
    text += array("UInt8", "types", "", t);
    return text + "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n"
                  "  <AppendedData encoding=\"raw\">\n_";
}

} // namespace

const char* byteOrder() { return __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "BigEndian" : "LittleEndian"; }

std::string xmlText(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const std::string escaped = c == '&'   ? "&amp;"
                                    : c == '<' ? "&lt;"
                                    : c == '>' ? "&gt;"
                                    : c == '"' ? "&quot;"
                                               : "";
        result += escaped.empty() ? std::string(1, c) : escaped;
    }
    return result;
}

std::int64_t localOf(const std::vector<PointRange>& ranges, std::int64_t id) {
    const auto above =
        std::upper_bound(ranges.begin(), ranges.end(), id,
                         [](std::int64_t i, const PointRange& range) { return i < range.first; });
    if (above == ranges.begin() || id >= (above - 1)->end()) return -1;
    return (above - 1)->local + (id - (above - 1)->first);
}

std::vector<std::int64_t> findGhosts(const SpoolFile& tets, std::int64_t tetCount,
                                     const std::vector<PointRange>& ranges) {
    std::vector<std::int64_t> ghosts;
    std::size_t unique = 0;
    forEachBatch<Tet>(tets, tetCount, [&](const std::vector<Tet>& batch) {
        for (const Tet& tet : batch) {
            for (const std::int64_t id : tet) {
                if (localOf(ranges, id) < 0) ghosts.push_back(id);
            }
        }
        // A ghost is met some twenty times.
        if (ghosts.size() < 2 * unique + std::size_t(kBatch)) return;
        sortUnique(ghosts);
        unique = ghosts.size();
    });
    sortUnique(ghosts);
    return ghosts;
}

std::uint64_t writePiece(const Piece& piece, const SpoolFile& points, const SpoolFile& tets,
                         OutputFile& file) {
    const auto ghosts = std::int64_t(piece.ghosts.size()), all = piece.points + ghosts;
    const std::string text = header(all, piece.tets, piece.float32);
    file.writeAt(0, text.data(), text.size());
    Appender out(file, text.size());
    out.begin(std::uint64_t(all) * 3 * (piece.float32 ? 4 : 8));
    const auto add = [&](const std::vector<openvdb::Vec3d>& places) {
        piece.float32 ? addPlaces<float>(out, places) : addPlaces<double>(out, places);
    };
    forEachBatch<openvdb::Vec3d>(points, piece.points, add);
    add(piece.places);
    out.begin(std::uint64_t(all) * 8);
    for (const PointRange& range : piece.ranges)
        out.addEach<std::int64_t>(range.count, [&](std::int64_t i) { return range.first + i; });
    out.add(piece.ghosts.data(), piece.ghosts.size());
    constexpr std::uint8_t kDuplicate = 1, kTetra = 10; // vtkDataSetAttributes::DUPLICATEPOINT, VTK_TETRA
    out.begin(std::uint64_t(all));
    out.addEach<std::uint8_t>(
        all, [&](std::int64_t i) { return i < piece.points ? std::uint8_t(0) : kDuplicate; });
    out.begin(std::uint64_t(piece.tets) * sizeof(Tet));
    forEachBatch<Tet>(tets, piece.tets, [&](std::vector<Tet>& batch) {
        for (Tet& tet : batch) {
            for (std::int64_t& id : tet) {
                const std::int64_t own = localOf(piece.ranges, id);
                id = own >= 0
                         ? own
                         : piece.points + (std::lower_bound(piece.ghosts.begin(), piece.ghosts.end(), id) -
                                           piece.ghosts.begin());
            }
        }
        out.add(batch.data(), batch.size());
    });
    out.begin(std::uint64_t(piece.tets) * 8);
    out.addEach<std::int64_t>(piece.tets, [](std::int64_t i) { return 4 * (i + 1); });
    out.begin(std::uint64_t(piece.tets));
    out.addEach<std::uint8_t>(piece.tets, [](std::int64_t) { return kTetra; });
    const std::string end = "\n  </AppendedData>\n</VTKFile>\n";
    out.add(end.data(), end.size());
    return out.at();
}

} // namespace vdbtet::mpi
