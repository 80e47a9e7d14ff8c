/// @file vdb_tet_mpi.cc
/// vdb_tet by the ranks of an MPI job: one mesh, made by all of them. Rank 0 speaks.
#include <vdbtet/mpi/MeshFile.h>
#include <vdbtet/mpi/PvtuFile.h>
#include <vdbtet/mpi/VolumeToTets.h>

#include "CommandLine.h"
#include "Console.h"
#include "Fields.h"
#include "Summary.h"
#include "UsageError.h"
#include "batch/Memory.h"
#include "io/GridPart.h"
#include "io/OutputFile.h"
#include "mpi/Comm.h"
#include "surface/TriangleMesh.h"

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>
#include <vdbtet/MeshScaler.h>

#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <memory>
#include <new>
#include <optional>

namespace {

namespace mpi = vdbtet::mpi;

/// The files that a signal must not leave behind; a name stays where it is once it is here.
std::vector<std::string> gTemporaries;
volatile std::sig_atomic_t gCount = 0;

/// When a rank dies, mpirun and srun end the others by SIGTERM: the last one to go leaves nothing.
void removeTemporaries() {
    for (int i = 0; i < gCount; ++i) ::unlink(gTemporaries[std::size_t(i)].c_str());
}

void removeAndEnd(int signal) {
    removeTemporaries();
    ::_exit(128 + signal);
}

void catchSignals() {
    struct sigaction action = {};
    action.sa_handler = removeAndEnd;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
    // A file that grows too large is an error as a full disk is.
    action.sa_handler = SIG_IGN;
    ::sigaction(SIGXFSZ, &action, nullptr);
}

/// Passes a mesh on to its file, or its totals to nobody in a dry run.
class Output final : public vdbtet::MeshSink {
public:
    explicit Output(const CommandLine& line) : mLine(line) {
        if (line.dryRun) return;
        if (isPvtu(line)) {
            mPieces = std::make_unique<mpi::PvtuFile>(MPI_COMM_WORLD, line.out);
            gTemporaries = mPieces->temporaries();
        } else {
            mFile =
                std::make_unique<mpi::MeshFile>(MPI_COMM_WORLD, line.out, line.format, line.formatOptions);
            gTemporaries = mFile->temporaries();
        }
        gCount = int(gTemporaries.size());
    }
    ~Output() override { gCount = 0; }

    bool begin(const vdbtet::MeshTotals& totals) override {
        if (mPieces) return mPieces->begin(totals);
        const std::string path = mLine.out.empty() || isPvtu(mLine) ? "mesh.vtu" : mLine.out;
        bytes = vdbtet::MeshFile::size(path, totals, mLine.format, mLine.formatOptions);
        return mFile && mFile->begin(totals);
    }
    void chunk(const vdbtet::MeshChunk& chunk) override {
        mPieces ? mPieces->chunk(chunk) : mFile->chunk(chunk);
    }
    void end() override {
        if (mFile) mFile->end();
        if (mPieces) {
            mPieces->end();
            bytes = mPieces->bytes();
        }
        gCount = 0;
    }
    bool concurrent() const override { return !mPieces; }
    vdbtet::MeshWants wants() const override { return mFile ? mFile->wants() : vdbtet::MeshWants(); }

    std::uint64_t bytes = 0;

private:
    const CommandLine& mLine;
    std::unique_ptr<mpi::MeshFile> mFile;
    std::unique_ptr<mpi::PvtuFile> mPieces; ///< in its place
};

/// @throw UsageError for what is one process's, or not known to several ranks yet
void requireKnown(const CommandLine& line) {
    const auto refuse = [](bool given, const char* what) {
        if (given) throw UsageError(std::string(what) + " is not known to vdb_tet_mpi; vdb_tet has it");
    };
    refuse(line.inputs.size() != 1 || !line.frames.empty() || line.allGrids || line.resume ||
               !line.log.empty(),
           "more than one mesh a run");
    refuse(isSurfaceFile(line.inputs[0]), "meshing a surface");
    refuse(!line.surface.empty(), "--surface");
    refuse(line.distance, "--distance");
    if (isPvtu(line) && line.formatOptions.compression > 0)
        throw UsageError(".pvtu files are written without compression; leave --compress out");
    if (isPvtu(line) && line.hasFields())
        throw UsageError(".pvtu files are written without fields; take a .vtkhdf or .vtu file for these");
    refuse(line.report.size() > 5 && line.report.rfind(".html") == line.report.size() - 5,
           "a report in HTML");
}

/// What each rank did, and how much memory it took: for the report.
nlohmann::json gatherRanks(const mpi::RankReport& own) {
    struct rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    const std::int64_t numbers[] = {
        own.surfaceTiles, own.borrowedTiles,     own.tets, own.leaves, own.sentToNeighbours,
        own.sentToAll,    usage.ru_maxrss * 1024};
    constexpr int kNumbers = sizeof numbers / sizeof *numbers;
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    std::vector<std::int64_t> all(std::size_t(size) * kNumbers);
    MPI_Allgather(numbers, kNumbers, MPI_INT64_T, all.data(), kNumbers, MPI_INT64_T, MPI_COMM_WORLD);
    nlohmann::json ranks = nlohmann::json::array();
    for (auto of = all.begin(); of != all.end(); of += kNumbers) {
        ranks.push_back({{"surfaceTiles", of[0]},
                         {"borrowedTiles", of[1]},
                         {"tets", of[2]},
                         {"leaves", of[3]},
                         {"bytesToNeighbours", of[4]},
                         {"bytesToAll", of[5]},
                         {"peakMemory", of[6]}});
    }
    return ranks;
}

/// The limit on memory of each rank: what is free on its host is shared out there, unless one is given.
vdbtet::Options withMemoryLimit(vdbtet::Options options) {
    const std::optional<std::int64_t> free = freeMemory();
    MPI_Comm host = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
    int ranks = 1;
    MPI_Comm_size(host, &ranks);
    MPI_Comm_free(&host);
    if (!options.maxMemory && free) options.maxMemory = std::max<std::int64_t>(*free / ranks, 1);
    return options;
}

/// All ranks' fields; each reads of the grids what it samples.
vdbtet::FieldOptions fieldsOf(const CommandLine& line) {
    vdbtet::FieldOptions fields;
    if (!line.hasFields()) return fields;
    mpi::Comm(MPI_COMM_WORLD).together([&] {
        fields = readFields(line, vdbtet::readGridHead(line.in, line.name)->getName(), /*delayLoad=*/true);
    });
    return fields;
}

void run(const CommandLine& given, bool speaks) {
    requireKnown(given);
    CommandLine line = given;
    line.in = line.inputs[0];
    std::unique_ptr<tbb::global_control> threads;
    if (line.threads > 0) {
        threads = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                        std::size_t(line.threads));
    }
    const auto start = std::chrono::steady_clock::now();
    Summary summary;
    mpi::RankReport own;
    {
        Output output(line);
        vdbtet::MeshScaler scaler(output, line.scale);
        vdbtet::MeshSink& written = line.scale == 1.0 ? static_cast<vdbtet::MeshSink&>(output) : scaler;
        vdbtet::FieldSampler sampler(written, fieldsOf(line));
        summary.report = mpi::volumeToTets({line.in, line.name}, sampler, withMemoryLimit(line.options),
                                           MPI_COMM_WORLD, {}, &own);
        summary.bytes = output.bytes;
        summary.gridType = own.gridType;
    }
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const nlohmann::json ranks = gatherRanks(own);
    if (!speaks) return;
    if (!line.report.empty()) {
        auto json = nlohmann::ordered_json::parse(asJson(line, summary));
        json["ranks"] = ranks;
        const std::string text = json.dump(2) + "\n";
        vdbtet::OutputFile file(line.report);
        file.writeAt(0, text.data(), text.size());
        file.commit();
    }
    if (!line.quiet) print(asText(line, summary));
}

/// @return the exit code
int work(int argc, char** argv, bool speaks) {
    const auto fail = [&](const char* message, int exitCode) {
        if (speaks) complain(message);
        return exitCode;
    };
    try {
        // All ranks parse, and one of them prints the help.
        if (!speaks) std::cout.setstate(std::ios_base::failbit);
        const auto line = parseCommandLine(argc, argv, true);
        if (line) run(*line, speaks);
        return 0;
    } catch (const UsageError& error) {
        return fail(error.what(), 2);
    } catch (const vdbtet::BadOption& error) {
        return fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        // This rank's alone: the others wait for it. Where all know of it, it is an Error.
        removeTemporaries();
        complain("out of memory");
        MPI_Abort(MPI_COMM_WORLD, 1);
        return 1;
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}

} // namespace

int main(int argc, char** argv) {
    holdStandardStreams();
    // OpenVDB logs through cerr; errors reach the user as exceptions, and go to stderr as one line.
    std::cerr.rdbuf(nullptr);
    int level = 0, rank = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    catchSignals();
    const int exitCode = work(argc, argv, rank == 0);
    MPI_Finalize();
    return exitCode;
}
