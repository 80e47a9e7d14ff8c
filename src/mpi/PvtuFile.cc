/// @file PvtuFile.cc
/// Spools, then whose points are missing, then the piece.
#include <vdbtet/mpi/PvtuFile.h>

#include "mpi/Comm.h"
#include "mpi/Piece.h"

#include "io/OutputFile.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace vdbtet::mpi {

struct PvtuFile::Impl {
    Impl(MPI_Comm communicator, const std::string& target) : comm(communicator), path(target) {}

    std::string pieceName(int rank) const {
        return path.stem().string() + "_" + std::to_string(rank) + ".vtu";
    }

    /// Get the places of points that are others' from those.
    /// @param ranges  of all ranks' points
    std::vector<openvdb::Vec3d> borrow(const std::vector<std::int64_t>& ghosts,
                                       const std::vector<std::vector<PointRange>>& ranges);

    std::string index() const;

    Comm comm;
    std::filesystem::path path;
    std::optional<OutputFile> file, indexFile; ///< the latter rank 0's
    std::optional<SpoolFile> points, tets;
    std::vector<PointRange> ranges; ///< of the own points
    std::int64_t pointCount = 0, tetCount = 0;
    MeshTotals totals;
    std::int64_t bytes = 0;
};

PvtuFile::PvtuFile(MPI_Comm comm, const std::string& path) : mImpl(std::make_unique<Impl>(comm, path)) {
    Impl& impl = *mImpl;
    impl.comm.together([&] {
        impl.file.emplace((impl.path.parent_path() / impl.pieceName(impl.comm.rank())).string());
        impl.points.emplace(*impl.file);
        impl.tets.emplace(*impl.file);
        if (impl.comm.rank() == 0) impl.indexFile.emplace(path);
    });
}

PvtuFile::~PvtuFile() = default;

bool PvtuFile::begin(const MeshTotals& totals) {
    if (!totals.pointFields.empty() || !totals.cellFields.empty())
        throw BadOption(".pvtu files are written without fields");
    mImpl->totals = totals;
    return true;
}

void PvtuFile::chunk(const MeshChunk& chunk) {
    Impl& impl = *mImpl;
    if (!chunk.points.empty()) {
        const auto count = std::int64_t(chunk.points.size());
        if (impl.ranges.empty() || impl.ranges.back().end() != chunk.firstPoint) {
            impl.ranges.push_back({chunk.firstPoint, count, impl.pointCount});
        } else {
            impl.ranges.back().count += count;
        }
        impl.pointCount += count;
        impl.points->append(chunk.points.data(), chunk.points.size() * sizeof(openvdb::Vec3d));
    }
    impl.tetCount += std::int64_t(chunk.tets.size());
    impl.tets->append(chunk.tets.data(), chunk.tets.size() * sizeof(Tet));
}

void PvtuFile::end() {
    Impl& impl = *mImpl;
    std::int64_t counts[] = {impl.pointCount, impl.tetCount};
    impl.comm.sum(counts, 2);
    std::vector<std::int64_t> ghosts;
    impl.comm.together([&] {
        if (counts[0] != impl.totals.points || counts[1] != impl.totals.tets)
            throw FileError("cannot write " + impl.path.string() + ": the mesh is not as large as announced");
        ghosts = findGhosts(*impl.tets, impl.tetCount, impl.ranges);
    });
    const std::vector<openvdb::Vec3d> places = impl.borrow(ghosts, impl.comm.gather(impl.ranges));
    impl.comm.together([&] {
        const Piece piece{impl.ranges,     ghosts,        places,
                          impl.pointCount, impl.tetCount, impl.totals.float32Suffices};
        impl.bytes = std::int64_t(writePiece(piece, *impl.points, *impl.tets, *impl.file));
        if (!impl.indexFile) return;
        const std::string index = impl.index();
        impl.indexFile->writeAt(0, index.data(), index.size());
        impl.bytes += std::int64_t(index.size());
    });
    impl.comm.sum(impl.bytes);
    impl.comm.together([&] { impl.file->commit(); });
    impl.comm.together([&] {
        if (impl.indexFile) impl.indexFile->commit();
    });
}

std::vector<openvdb::Vec3d> PvtuFile::Impl::borrow(const std::vector<std::int64_t>& ghosts,
                                                   const std::vector<std::vector<PointRange>>& allRanges) {
    std::vector<Bytes> wishes(allRanges.size());
    std::vector<std::size_t> owners;
    struct Owned {
        PointRange range;
        std::size_t rank;
    };
    std::vector<Owned> all;
    for (std::size_t rank = 0; rank < allRanges.size(); ++rank) {
        for (const PointRange& range : allRanges[rank]) all.push_back({range, rank});
    }
    std::sort(all.begin(), all.end(),
              [](const Owned& a, const Owned& b) { return a.range.first < b.range.first; });
    for (const std::int64_t id : ghosts) {
        const auto above =
            std::upper_bound(all.begin(), all.end(), id,
                             [](std::int64_t i, const Owned& owned) { return i < owned.range.first; });
        owners.push_back((above - 1)->rank);
        pack(wishes[owners.back()], id);
    }
    std::vector<Bytes> answers(allRanges.size());
    const std::vector<Bytes> asked = comm.exchange(wishes);
    comm.together([&] {
        for (std::size_t rank = 0; rank < asked.size(); ++rank) {
            for (Unpacker next(asked[rank]); !next.done();) {
                openvdb::Vec3d place;
                points->readAt(std::uint64_t(localOf(ranges, next.next<std::int64_t>())) * sizeof place,
                               &place, sizeof place);
                pack(answers[rank], place);
            }
        }
    });
    const std::vector<Bytes> given = comm.exchange(answers);
    std::vector<Unpacker> next(given.begin(), given.end());
    std::vector<openvdb::Vec3d> places;
    for (const std::size_t owner : owners) places.push_back(next[owner].next<openvdb::Vec3d>());
    return places;
}

std::string PvtuFile::Impl::index() const {
    const std::string type = totals.float32Suffices ? "Float32" : "Float64";
    std::string text = "<?xml version=\"1.0\"?>\n"
                       "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"" +
                       std::string(byteOrder()) +
                       "\" header_type=\"UInt64\">\n"
                       "  <PUnstructuredGrid GhostLevel=\"0\">\n"
                       "    <PPointData GlobalIds=\"GlobalPointIds\">\n"
                       "      <PDataArray type=\"Int64\" Name=\"GlobalPointIds\"/>\n"
                       "      <PDataArray type=\"UInt8\" Name=\"vtkGhostType\"/>\n"
                       "    </PPointData>\n"
                       "    <PPoints>\n"
                       "      <PDataArray type=\"" +
                       type +
                       "\" Name=\"Points\" NumberOfComponents=\"3\"/>\n"
                       "    </PPoints>\n";
    for (int rank = 0; rank < comm.size(); ++rank)
        text += "    <Piece Source=\"" + xmlText(pieceName(rank)) + "\"/>\n";
    return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

std::vector<std::string> PvtuFile::temporaries() const {
    std::vector<std::string> names;
    for (const auto* file : {&mImpl->file, &mImpl->indexFile}) {
        if (*file && !(*file)->temporary().empty())
            names.push_back(std::filesystem::absolute((*file)->temporary()).string());
    }
    return names;
}

std::uint64_t PvtuFile::bytes() const { return std::uint64_t(mImpl->bytes); }

} // namespace vdbtet::mpi
