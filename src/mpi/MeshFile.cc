/// @file MeshFile.cc
/// Rank 0 makes the files, and gives them their names in the end.
#include <vdbtet/mpi/MeshFile.h>

#include "mpi/Comm.h"

#include "io/formats/Format.h"

#include <vdbtet/Errors.h>

#include <sys/vfs.h>

#include <atomic>
#include <filesystem>

namespace vdbtet::mpi {

namespace {

bool isOnNfs(const std::string& path) {
    constexpr long kNfs = 0x6969; // NFS_SUPER_MAGIC of linux/magic.h
    struct statfs info = {};
    return ::statfs(path.c_str(), &info) == 0 && long(info.f_type) == kNfs;
}

/// @return whether the ranks are on more hosts than one.
bool onSeveralHosts(MPI_Comm comm) {
    MPI_Comm host = MPI_COMM_NULL;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
    int all = 0, here = 0;
    MPI_Comm_size(comm, &all);
    MPI_Comm_size(host, &here);
    MPI_Comm_free(&host);
    int several = here < all ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &several, 1, MPI_INT, MPI_MAX, comm);
    return several != 0;
}

} // namespace

struct MeshFile::Impl {
    Impl(MPI_Comm communicator, std::string target, std::string name, const FormatOptions& with)
        : comm(communicator), path(std::move(target)), formatName(std::move(name)), options(with) {}

    Comm comm;
    std::string path, formatName;
    FormatOptions options;
    std::deque<RecordFile> files;
    std::vector<std::string> temporaries;
    std::unique_ptr<const Format> format;
    std::uint64_t bytes = 0;
    std::atomic<std::int64_t> points{0}, tets{0}; ///< written by this rank
    MeshTotals totals;
};

MeshFile::MeshFile(MPI_Comm comm, const std::string& path, const std::string& format,
                   const FormatOptions& options)
    : mImpl(std::make_unique<Impl>(comm, path, format, options)) {
    Impl& impl = *mImpl;
    impl.comm.together([&] {
        vdbtet::MeshFile::formatOf(path, format, options); // or throw
        if (options.compression > 0)
            throw BadOption(
                "several ranks write no compressed files, of which no place is known ahead; leave "
                "--compress out");
    });
    const bool several = onSeveralHosts(comm);
    impl.comm.together([&] {
        if (impl.comm.rank() != 0) return;
        for (const std::string& file : vdbtet::MeshFile::filesOf(path, format)) {
            impl.files.emplace_back(file, OutputFile::Shared());
            impl.temporaries.push_back(
                std::filesystem::absolute(impl.files.back().file().temporary()).string());
        }
        if (several && isOnNfs(impl.temporaries[0])) {
            throw FileError(
                "cannot write " + path +
                ": it is on NFS, where hosts may not write one file together; choose another file "
                "system, or ranks on one host");
        }
    });
    const auto count =
        std::size_t(std::stoul(impl.comm.fromRank(0, std::to_string(impl.temporaries.size()))));
    impl.temporaries.resize(count);
    for (std::string& name : impl.temporaries) name = impl.comm.fromRank(0, name);
    impl.comm.together([&] {
        if (impl.comm.rank() == 0) return;
        const auto names = vdbtet::MeshFile::filesOf(path, format);
        for (std::size_t i = 0; i < count; ++i) impl.files.emplace_back(names[i], impl.temporaries[i]);
    });
}

MeshFile::~MeshFile() = default;

bool MeshFile::begin(const MeshTotals& totals) {
    Impl& impl = *mImpl;
    impl.totals = totals;
    impl.comm.together([&] {
        impl.format = makeFormat(impl.path, impl.formatName, totals, impl.options);
        const auto& layouts = impl.format->layouts();
        for (std::size_t i = 0; i < layouts.size(); ++i) {
            if (impl.comm.rank() == 0) impl.files[i].start(layouts[i]);
            impl.bytes += layouts[i].size();
        }
    });
    return true;
}

void MeshFile::chunk(const MeshChunk& chunk) {
    mImpl->format->write(chunk, mImpl->files);
    mImpl->points += std::int64_t(chunk.points.size());
    mImpl->tets += std::int64_t(chunk.tets.size());
}

void MeshFile::end() {
    Impl& impl = *mImpl;
    std::int64_t counts[] = {impl.points, impl.tets};
    impl.comm.sum(counts, 2);
    impl.comm.together([&] {
        if (counts[0] != impl.totals.points || counts[1] != impl.totals.tets)
            throw FileError("cannot write " + impl.path + ": the mesh is not as large as announced");
        if (impl.comm.rank() == 0) return;
        for (RecordFile& file : impl.files) file.file().leave();
    });
    std::vector<std::uint32_t> checksums(impl.format->checksums().size());
    impl.comm.forEachRank(impl.format->checksums(), [&](const auto& part) {
        for (std::size_t i = 0; i < part.size(); ++i) checksums[i] ^= part[i];
    });
    impl.comm.together([&] {
        if (impl.comm.rank() != 0) return;
        impl.format->finish(impl.files, checksums);
        for (RecordFile& file : impl.files) file.commit();
    });
}

MeshWants MeshFile::wants() const {
    MeshWants wants;
    wants.triangles = mImpl->format && mImpl->format->wantsTriangles();
    return wants;
}

std::uint64_t MeshFile::bytes() const { return mImpl->bytes; }

const std::vector<std::string>& MeshFile::temporaries() const { return mImpl->temporaries; }

} // namespace vdbtet::mpi
