// From a command line to jobs.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include "UsageError.h"
#include "batch/Plan.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace {

std::vector<std::string> noGrids(const std::string&) { throw std::logic_error("nobody asked"); }

CommandLine lineOf(const std::vector<std::string>& inputs, const std::string& out) {
    CommandLine line;
    line.inputs = inputs;
    line.out = out;
    return line;
}

std::vector<std::string> outsOf(const std::vector<Job>& jobs) {
    std::vector<std::string> outs;
    for (const Job& job : jobs) outs.push_back(job.line.out);
    return outs;
}

using Names = std::vector<std::string>;

} // namespace

TEST_CASE("each input is a job") {
    const auto jobs = planJobs(lineOf({"in/a.vdb", "b.0007.vdb"}, "out/{stem}.vtu"), noGrids);
    REQUIRE(jobs.size() == 2);
    CHECK(jobs[0].line.in == "in/a.vdb");
    CHECK_FALSE(jobs[0].frame);
    CHECK(jobs[1].line.in == "b.0007.vdb");
    CHECK(jobs[1].frame == "0007");
    CHECK(outsOf(jobs) == Names{"out/a.vtu", "out/b.0007.vtu"});
}

TEST_CASE("frames of a sequence are jobs, whose number goes into all names") {
    CommandLine line = lineOf({"in.%04d.vdb"}, "{frame}.vtu");
    line.frames = "8-12x2";
    line.report = "{stem}.json";
    line.surface = "s.####.ply";
    const auto jobs = planJobs(line, noGrids);
    CHECK(outsOf(jobs) == Names{"0008.vtu", "0010.vtu", "0012.vtu"});
    CHECK(jobs[1].line.in == "in.0010.vdb");
    CHECK(jobs[1].line.report == "in.0010.json");
    CHECK(jobs[1].line.surface == "s.0010.ply");
    CHECK(jobs[1].outputs() == Names{"0010.vtu", "s.0010.ply", "in.0010.json"});

    line.inputs = {"in.vdb"};
    CHECK_THROWS_AS(planJobs(line, noGrids), UsageError); // no place for the number
    CHECK_THROWS_AS(planJobs(lineOf({"in.%04d.vdb"}, "{frame}.vtu"), noGrids), UsageError); // which frames?
}

TEST_CASE("all grids of a file are jobs, and a file that cannot be listed is one that fails") {
    CommandLine line = lineOf({"a.vdb", "bad.vdb"}, "{stem}_{grid}.vtu");
    line.allGrids = true;
    const auto jobs = planJobs(line, [](const std::string& path) -> Names {
        if (path == "bad.vdb") throw std::runtime_error("it is damaged");
        return {"density", "../b"};
    });
    REQUIRE(jobs.size() == 3);
    CHECK(jobs[0].line.name == "density");
    CHECK(jobs[0].line.out == "a_density.vtu");
    CHECK(jobs[1].line.name == "../b");
    CHECK(jobs[1].line.out == "a__._b.vtu"); // a name is no folder
    CHECK(jobs[2].error == "it is damaged");
    CHECK(jobs[2].line.in == "bad.vdb");
}

TEST_CASE("there is an end to the number of jobs") {
    CommandLine line = lineOf({"a.#.vdb", "b.#.vdb", "c.#.vdb"}, "{stem}.vtu");
    line.frames = "1-50000";
    CHECK_THROWS_AS(planJobs(line, noGrids), UsageError);
    line = lineOf({"a.vdb"}, "{grid}.vtu");
    line.allGrids = true;
    CHECK_THROWS_AS(planJobs(line, [](const std::string&) { return Names(100001, "density"); }), UsageError);
}

TEST_CASE("no file is written twice, nor over one that is read") {
    CHECK_THROWS_WITH(planJobs(lineOf({"a.vdb", "b.vdb"}, "o.vtu"), noGrids),
                      "a.vdb and b.vdb would both be written to o.vtu; put {stem} or {frame} into OUT");
    CHECK_THROWS_AS(planJobs(lineOf({"x/a.vdb", "y/a.vdb"}, "{stem}.vtu"), noGrids), UsageError);
    // A format of several files.
    CHECK_THROWS_AS(planJobs(lineOf({"a.vdb", "a.ele"}, "{stem}.node"), noGrids), UsageError);

    CommandLine line = lineOf({"a.vdb"}, "o.vtu");
    line.report = "./o.vtu";
    CHECK_THROWS_WITH(planJobs(line, noGrids), "OUT and --report are the same file: ./o.vtu");
    line.report = "o.json";
    line.log = "x/../o.json";
    CHECK_THROWS_AS(planJobs(line, noGrids), UsageError);
    line.log = "a.vdb";
    CHECK_THROWS_AS(planJobs(line, noGrids), UsageError);
    line.log.clear();
    line.fieldsFrom = "o.vtu";
    CHECK_THROWS_AS(planJobs(line, noGrids), UsageError);
}

TEST_CASE("a job is up to date when all outputs are newer than all inputs") {
    const vdbtet::test::TempFolder folder;
    const auto put = [&](const std::string& name, int age) {
        const std::string path = folder.file(name);
        std::ofstream(path) << name;
        std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() -
                                                   std::chrono::seconds(age));
    };
    CommandLine line = lineOf({folder.file("a.vdb")}, folder.file("o.vtu"));
    line.report = folder.file("o.json");
    const auto upToDate = [&] { return isUpToDate(planJobs(line, noGrids).at(0)); };
    CHECK_FALSE(upToDate());
    put("a.vdb", 50);
    put("o.vtu", 40);
    CHECK_FALSE(upToDate()); // no report
    put("o.json", 60);
    CHECK_FALSE(upToDate()); // of an earlier run
    put("o.json", 40);
    CHECK(upToDate());
    line.fieldsFrom = folder.file("b.vdb");
    CHECK_FALSE(upToDate());
    put("b.vdb", 30);
    CHECK_FALSE(upToDate());
    put("b.vdb", 45);
    CHECK(upToDate());
    put("a.vdb", 0);
    CHECK_FALSE(upToDate());
    put("a.vdb", 50);
    line.dryRun = true;
    CHECK(upToDate()); // the report is all there is
    line.report.clear();
    CHECK_FALSE(upToDate());
}
