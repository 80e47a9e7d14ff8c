/// @file vdb_tet.cc
/// The command-line tool: parse, plan, and have each mesh made by a child process.
#include "CommandLine.h"
#include "Console.h"
#include "Info.h"
#include "UsageError.h"
#include "batch/Batch.h"
#include "batch/Plan.h"
#include "process/Query.h"
#include "process/Signals.h"

#include <vdbtet/Errors.h>
#include <vdbtet/GridFile.h>

#include <exception>
#include <iostream>
#include <new>

namespace {

int run(const CommandLine& line) {
    const Signals signals;
    const auto grids = [&](const std::string& path) {
        return ask(path, signals, [&](const Channel& channel) { channel.send(vdbtet::scalarGrids(path)); });
    };
    return Batch(line, planJobs(line, grids), signals).run();
}

int fail(const char* message, int exitCode) {
    complain(message);
    return exitCode;
}

} // namespace

int main(int argc, char** argv) {
    holdStandardStreams();
    // OpenVDB logs through cerr; errors reach the user as exceptions, and go to stderr as one line.
    std::cerr.rdbuf(nullptr);
    try {
        if (argc > 1 && argv[1] == std::string("info")) return info(argc - 1, argv + 1);
        const auto line = parseCommandLine(argc, argv);
        return line ? run(*line) : 0;
    } catch (const UsageError& error) {
        return fail(error.what(), 2);
    } catch (const vdbtet::BadOption& error) {
        return fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return fail("out of memory", 1);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}
