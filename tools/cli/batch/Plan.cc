/// @file Plan.cc
/// Files x frames x grids.
#include "batch/Plan.h"

#include "UsageError.h"
#include "batch/Frames.h"

#include <vdbtet/MeshFile.h>

#include <fmt/format.h>

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

namespace {

namespace fs = std::filesystem;

/// A job takes some 1.3 kB.
constexpr std::size_t kMostJobs = 100000;

/// @param count  that there are already
void requireRoom(std::size_t count) {
    if (count == kMostJobs)
        throw UsageError(fmt::format("more than {} meshes; make them in several runs", kMostJobs));
}

/// A file that is read, and the number in its name.
struct Input {
    std::string path;
    std::optional<std::string> frame;
    std::optional<FramePattern> pattern; ///< that the number was put into
};

std::vector<Input> inputsOf(const CommandLine& line) {
    std::vector<Input> inputs;
    const auto frames = line.frames.empty() ? std::vector<std::int64_t>() : parseFrames(line.frames);
    for (const std::string& path : line.inputs) {
        const auto pattern = FramePattern::find(path);
        std::error_code error;
        if (!pattern && !frames.empty()) {
            throw UsageError(
                fmt::format("--frames is given, but {} has no place for a frame's number, such as "
                            "%04d or ####",
                            path));
        }
        if (frames.empty() && pattern && !fs::exists(path, error)) {
            throw UsageError(
                fmt::format("{} stands for a sequence: say which frames by --frames, such as 1-240", path));
        }
        if (frames.empty()) inputs.push_back({path, lastNumber(fs::path(path).stem().string()), {}});
        for (const std::int64_t frame : frames) {
            requireRoom(inputs.size());
            const std::string number = pattern->number(frame);
            inputs.push_back({pattern->path(number), number, pattern});
        }
    }
    return inputs;
}

/// A name for a file from that of a grid: neither another folder nor hidden.
std::string asFileName(std::string grid) {
    std::replace(grid.begin(), grid.end(), '/', '_');
    if (!grid.empty() && grid[0] == '.') grid[0] = '_';
    return grid;
}

Job makeJob(const CommandLine& line, const Input& input, const std::string& grid) {
    Job job{line, input.frame, {}};
    job.line.inputs.clear();
    job.line.in = input.path;
    job.line.name = grid;
    Placeholders values{fs::path(input.path).stem().string(), input.frame, {}};
    if (!grid.empty()) values.grid = asFileName(grid);
    const std::pair<const char*, std::string*> names[] = {
        {"OUT", &job.line.out}, {"--report", &job.line.report}, {"--surface", &job.line.surface}};
    for (const auto& [option, name] : names) {
        const auto pattern = input.pattern ? FramePattern::find(*name) : std::nullopt;
        if (pattern) *name = pattern->path(pattern->number(std::stoll(*input.frame)));
        *name = fillIn(*name, values, option);
    }
    return job;
}

/// The same for all names of a file, and for one that is not there yet.
std::string identity(const std::string& path) {
    struct stat info = {};
    if (::stat(path.c_str(), &info) == 0) return fmt::format("{}:{}", info.st_dev, info.st_ino);
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? path : whole.string();
}

/// Refuses files that are written twice, or read and written.
class FileCheck {
public:
    explicit FileCheck(const CommandLine& line) : mLine(line) {}

    void reads(const char* role, const std::string& path) {
        if (!path.empty()) mFiles.emplace(identity(path), Use{role, path, path});
    }
    /// @param input  that the output is of
    void writes(const char* role, const std::string& path, const std::string& input) {
        if (path.empty()) return;
        const auto [other, isNew] = mFiles.emplace(identity(path), Use{role, path, input});
        if (isNew) return;
        const Use& first = other->second;
        if (first.role == std::string(role)) {
            throw UsageError(fmt::format("{} and {} would both be written to {}; put {} into {}", first.input,
                                         input, path,
                                         mLine.allGrids ? "{grid} and {stem}" : "{stem} or {frame}", role));
        }
        throw UsageError(fmt::format("{} and {} are the same file: {}", first.role, role, path));
    }

private:
    struct Use {
        std::string role, path, input;
    };
    const CommandLine& mLine;
    std::map<std::string, Use> mFiles;
};

void checkFiles(const CommandLine& line, const std::vector<Job>& jobs) {
    FileCheck check(line);
    for (const Job& job : jobs) check.reads("IN", job.line.in);
    check.reads("--fields-from", line.fieldsFrom);
    check.writes("--log", line.log, "");
    for (const Job& job : jobs) {
        if (!job.error.empty()) continue;
        if (!job.line.out.empty()) {
            for (const auto& path : vdbtet::MeshFile::filesOf(job.line.out, line.format))
                check.writes("OUT", path, job.label());
        }
        check.writes("--report", job.line.report, job.label());
        check.writes("--surface", job.line.surface, job.label());
    }
}

std::optional<struct timespec> modified(const std::string& path) {
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0) return std::nullopt;
#ifdef __APPLE__
    return info.st_mtimespec;
#else
    return info.st_mtim;
#endif
}

bool isNewer(const struct timespec& a, const struct timespec& b) {
    return std::tie(a.tv_sec, a.tv_nsec) > std::tie(b.tv_sec, b.tv_nsec);
}

} // namespace

std::string Job::label() const { return line.allGrids ? line.in + " " + line.name : line.in; }

std::vector<std::string> Job::outputs() const {
    std::vector<std::string> paths;
    if (!line.dryRun) paths = vdbtet::MeshFile::filesOf(line.out, line.format);
    if (!line.dryRun && !line.surface.empty()) paths.push_back(line.surface);
    if (!line.report.empty()) paths.push_back(line.report);
    return paths;
}

std::vector<Job> planJobs(const CommandLine& line, const ListGrids& listGrids) {
    std::vector<Job> jobs;
    for (const Input& input : inputsOf(line)) {
        if (!line.allGrids) {
            jobs.push_back(makeJob(line, input, line.name));
            continue;
        }
        try {
            for (const std::string& grid : listGrids(input.path)) {
                requireRoom(jobs.size());
                jobs.push_back(makeJob(line, input, grid));
            }
        } catch (const UsageError&) {
            throw;
        } catch (const std::exception& error) {
            jobs.push_back({line, input.frame, error.what()});
            jobs.back().line.in = input.path;
        }
    }
    checkFiles(line, jobs);
    return jobs;
}

bool isUpToDate(const Job& job) {
    const auto outputs = job.outputs();
    if (outputs.empty()) return false;
    for (const std::string& in : {job.line.in, job.line.fieldsFrom}) {
        if (in.empty()) continue;
        const auto read = modified(in);
        const bool all = read && std::all_of(outputs.begin(), outputs.end(), [&](const std::string& path) {
                             const auto written = modified(path);
                             return written && isNewer(*written, *read);
                         });
        if (!all) return false;
    }
    return true;
}
