// What people are told of jobs.
#include "support/Catch.h"

#include "batch/Outcome.h"

TEST_CASE("a child that ended without a word gets a line by its stage and end") {
    Worker::End end;
    end.signal = 11;
    CHECK(epitaph("a.vdb", "read", end) == "a.vdb: reading it crashed (signal 11); the file is damaged");
    CHECK(epitaph("a.vdb", "cuts", end) ==
          "a.vdb: the stage cuts crashed (signal 11); the file may be damaged, or vdb_tet has a bug");
    end.signal = 9;
    CHECK(epitaph("a.vdb", "emit", end) ==
          "a.vdb: killed (signal 9) in the stage emit; if memory ran out, use "
          "fewer --jobs, or a coarser --spacing");
    end = {};
    end.code = 3;
    CHECK(epitaph("a.vdb", "read", end) == "a.vdb: reading it crashed (exit code 3); the file is damaged");
}

TEST_CASE("the table has a line a job, and one for all") {
    std::vector<Job> jobs(3);
    jobs[0].line.in = "a.vdb";
    jobs[1].line.in = "long.vdb";
    jobs[2].line.in = "c.vdb";
    std::vector<Outcome> outcomes(3);
    outcomes[0].status = Outcome::Status::Done;
    outcomes[0].done = {{"tets", 12345}, {"angles", {14.758, 153.72}}};
    outcomes[0].seconds = 1.234;
    outcomes[0].peakMemory = 65000000;
    outcomes[1].status = Outcome::Status::Failed;
    outcomes[2].status = Outcome::Status::Skipped;
    CHECK(outcomeTable(jobs, outcomes, false, 1.5) ==
          "input     status    tets           angles    time   memory\n"
          "a.vdb     written  12345  14.76 to 153.72  1.23 s  65.0 MB\n"
          "long.vdb  failed\n"
          "c.vdb     skipped\n"
          "1 written, 1 failed, 1 skipped, in 1.50 s\n");
    outcomes[0].status = Outcome::Status::Interrupted;
    outcomes[1].status = Outcome::Status::Waiting;
    CHECK(outcomeTable(jobs, outcomes, false, 1.5).find("1 skipped, 1 interrupted, 1 not begun, in") !=
          std::string::npos);
}
