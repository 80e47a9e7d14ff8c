/// @file fuzz_options.cc
/// Bytes are a command line, an argument after the other. It is parsed and planned, or there is an error that
/// says why.
#include "CommandLine.h"
#include "UsageError.h"
#include "batch/Plan.h"

#include <vdbtet/Errors.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "not so: %s\n", what);
    std::abort();
}

/// What the rest of the tool relies on. Options of the mesher are for that to judge.
void requireSound(const CommandLine& line) {
    require(!line.inputs.empty(), "there is an input");
    require(!line.out.empty() || line.dryRun, "there is an output");
    require(line.threads >= 0 && line.jobs >= 0, "counts are positive");
    require(std::isfinite(line.scale) && line.scale > 0.0, "the scale is a positive number");
    const vdbtet::Options& options = line.options;
    require(std::isfinite(options.voxels) && options.voxels > 0.0, "voxels are a positive number");
    require(!options.spacing || (std::isfinite(*options.spacing) && *options.spacing > 0.0),
            "the spacing is a positive number");
}

void parse(const std::vector<const char*>& arguments) {
    const auto line = parseCommandLine(int(arguments.size()), arguments.data());
    if (!line) return; // has printed help
    requireSound(*line);
    const auto grids = [](const std::string&) { return std::vector<std::string>{"density", "../v[1]", ""}; };
    for (const Job& job : planJobs(*line, grids)) {
        require(!job.line.in.empty() && job.line.inputs.empty(), "a job has one input");
        require(line->dryRun || !job.outputs().empty(), "a job has an output");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> arguments = {"vdb_tet", ""};
    for (std::size_t i = 0; i < size; ++i) {
        if (data[i] == '\0' || data[i] == '\n') {
            arguments.emplace_back();
        } else {
            arguments.back() += char(data[i]);
        }
    }
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    try {
        parse(pointers);
    } catch (const UsageError& error) {
        require(error.what()[0] != '\0', "an error has a reason");
    } catch (const vdbtet::Error& error) {
        require(error.what()[0] != '\0', "an error has a reason");
    }
    return 0;
}
