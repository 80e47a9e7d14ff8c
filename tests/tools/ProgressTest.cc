// One number and one line for how far the work is.
#include "support/Catch.h"

#include "batch/Progress.h"

TEST_CASE("the progress of a job rises from 0 to 1 through its stages") {
    CommandLine line;
    line.options.grade = GENERATE(false, true);
    line.dryRun = GENERATE(false, true);
    if (GENERATE(false, true)) line.options.optimize = 30;
    JobProgress progress(line);
    CHECK(progress.fraction() == 0.0);
    double last = 0.0;
    const std::vector<std::string> stages = {"read",    "fields",
                                             "scan",    "tiles",
                                             "cuts",    "layout",
                                             "labels",  "destinations",
                                             "flips",   "repair",
                                             "grading", "numbering",
                                             "begin",   line.dryRun ? "measure" : "emit"};
    for (const std::string& stage : stages) {
        for (const int percent : {0, -1, 50, 100}) {
            progress.update(stage, percent, 0);
            CHECK(progress.fraction() >= last);
            last = progress.fraction();
        }
    }
    CHECK(last < 1.0);
    progress.update("end", 100, 7);
    CHECK(progress.fraction() == Approx(1.0));
    CHECK(progress.tets() == 7);
    CHECK(progress.stage() == "end");
}

TEST_CASE("progress never falls, and stages without a share change nothing") {
    JobProgress progress((CommandLine()));
    progress.update("emit", 50, 1000);
    const double before = progress.fraction();
    CHECK(before > 0.3);
    progress.update("cuts", 10, 0); // meshed again with a margin
    CHECK(progress.fraction() == before);
    CHECK(progress.tets() == 1000);
    progress.update("of another library", 99, 0);
    CHECK(progress.fraction() == before);
}

TEST_CASE("a line tells stage, percent, speed and time left") {
    Overview one;
    one.stage = "emit";
    one.fraction = 0.25;
    one.tets = 30000000;
    one.seconds = 10.0;
    CHECK(progressText(one) == "emit, 25 %, 3.0 M tets/s, 0:30 left");
    one.fraction = 0.001;
    one.tets = 0;
    CHECK(progressText(one) == "emit, 0 %");
    one.fraction = 0.02;
    one.seconds = 100;
    CHECK(progressText(one) == "emit, 2 %, 1:21:40 left");

    Overview batch;
    batch.jobs = 24;
    batch.done = 12;
    batch.running = 2;
    batch.fraction = 0.5;
    batch.tets = 50000;
    batch.seconds = 10.0;
    CHECK(progressText(batch) == "12 of 24 done, 2 running, 50 %, 5.0 k tets/s, 0:10 left");
    batch.failed = 1;
    CHECK(progressText(batch) == "12 of 24 done, 1 failed, 2 running, 50 %, 5.0 k tets/s, 0:10 left");
}

TEST_CASE("a terminal's line changes often, others come every ten seconds, and quiet ones never") {
    using Mode = ProgressDisplay::Mode;
    CHECK(ProgressDisplay::isDue(Mode::Live, 0.0, 0.2));
    CHECK_FALSE(ProgressDisplay::isDue(Mode::Live, 1.0, 1.05));
    CHECK_FALSE(ProgressDisplay::isDue(Mode::Lines, 0.0, 9.9));
    CHECK(ProgressDisplay::isDue(Mode::Lines, 0.0, 10.0));
    CHECK_FALSE(ProgressDisplay::isDue(Mode::Lines, 10.0, 19.0));
    CHECK_FALSE(ProgressDisplay::isDue(Mode::None, 0.0, 1e6));
    CHECK(ProgressDisplay::modeOf(true) == Mode::None);
}
