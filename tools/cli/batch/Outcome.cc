/// @file Outcome.cc
/// The closing table of a batch.
#include "batch/Outcome.h"

#include "Summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <map>

namespace {

using Status = Outcome::Status;
using Row = std::array<std::string, 6>;

const char* name(Status status, bool dryRun) {
    switch (status) {
    case Status::Done:
        return dryRun ? "counted" : "written";
    case Status::Failed:
        return "failed";
    case Status::Skipped:
        return "skipped";
    case Status::Interrupted:
        return "interrupted";
    default:
        return "not begun";
    }
}

Row rowOf(const Job& job, const Outcome& outcome, bool dryRun) {
    Row row = {job.label(), name(outcome.status, dryRun), "", "", "", ""};
    if (outcome.status == Status::Done) {
        const auto& angles = outcome.done["angles"];
        row[2] = fmt::format("{}", outcome.done["tets"].get<std::int64_t>());
        row[3] = fmt::format("{:.2f} to {:.2f}", angles[0].get<double>(), angles[1].get<double>());
    }
    if (outcome.peakMemory > 0) {
        row[4] = fmt::format("{:.2f} s", outcome.seconds);
        row[5] = humanSize(std::uint64_t(outcome.peakMemory));
    }
    return row;
}

} // namespace

std::string epitaph(const std::string& label, const std::string& stage, const Worker::End& end) {
    const std::string how =
        end.signal != 0 ? fmt::format("signal {}", end.signal) : fmt::format("exit code {}", end.code);
    if (end.signal == SIGKILL) {
        return fmt::format("{}: killed (signal 9) in the stage {}; if memory ran out, use fewer --jobs, or a "
                           "coarser --spacing",
                           label, stage);
    }
    if (stage == "read" && end.signal == SIGXCPU)
        return fmt::format("{}: reading it takes much too long for its size; the file is damaged", label);
    if (stage == "read") return fmt::format("{}: reading it crashed ({}); the file is damaged", label, how);
    return fmt::format("{}: the stage {} crashed ({}); the file may be damaged, or vdb_tet has a bug", label,
                       stage, how);
}

std::string outcomeTable(const std::vector<Job>& jobs, const std::vector<Outcome>& outcomes, bool dryRun,
                         double seconds) {
    std::vector<Row> rows = {{"input", "status", "tets", "angles", "time", "memory"}};
    for (std::size_t i = 0; i < jobs.size(); ++i) rows.push_back(rowOf(jobs[i], outcomes[i], dryRun));
    std::array<std::size_t, 6> widths = {};
    for (const Row& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line = fmt::format("{:<{}}  {:<{}}", row[0], widths[0], row[1], widths[1]);
        for (std::size_t c = 2; c < row.size(); ++c) line += fmt::format("  {:>{}}", row[c], widths[c]);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    std::map<Status, int> counts;
    for (const Outcome& outcome : outcomes) ++counts[outcome.status];
    std::string all;
    for (const Status status :
         {Status::Done, Status::Failed, Status::Skipped, Status::Interrupted, Status::Waiting}) {
        if (counts[status] > 0) all += fmt::format("{} {}, ", counts[status], name(status, dryRun));
    }
    return text + all + fmt::format("in {:.2f} s\n", seconds);
}
