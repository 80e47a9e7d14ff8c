// Lists of frames, and names with places for them.
#include "support/Catch.h"

#include "UsageError.h"
#include "batch/Frames.h"

using Frames = std::vector<std::int64_t>;

TEST_CASE("lists of frames hold frames, ranges, and ranges in steps") {
    CHECK(parseFrames("7") == Frames{7});
    CHECK(parseFrames("1-4") == Frames{1, 2, 3, 4});
    CHECK(parseFrames("1-10x4") == Frames{1, 5, 9});
    CHECK(parseFrames("1,5,10-12") == Frames{1, 5, 10, 11, 12});
    CHECK(parseFrames("-2-1") == Frames{-2, -1, 0, 1});
    CHECK(parseFrames("3-3x9") == Frames{3});
    CHECK(parseFrames("5,1-6") == Frames{5, 1, 2, 3, 4, 6}); // each once
}

TEST_CASE("lists that make no sense are refused") {
    for (const char* list : {"", "x", "1-", "1-5x", "1-5x0", "5-1", "1,,2", "1 - 5", "1-5-9", "1.5"}) {
        CAPTURE(list);
        CHECK_THROWS_AS(parseFrames(list), UsageError);
    }
    CHECK_THROWS_AS(parseFrames("1-100001"), UsageError);
    CHECK_THROWS_AS(parseFrames(std::string(200000, '1')), UsageError);
}

TEST_CASE("patterns put a frame's number into a file's name") {
    const auto path = [](const char* pattern, std::int64_t frame) {
        const auto found = FramePattern::find(pattern);
        REQUIRE(found);
        return found->path(found->number(frame));
    };
    CHECK(path("a.%04d.vdb", 7) == "a.0007.vdb");
    CHECK(path("a.%4d.vdb", 7) == "a.0007.vdb");
    CHECK(path("a%d.vdb", 12) == "a12.vdb");
    CHECK(path("a.####.vdb", 7) == "a.0007.vdb");
    CHECK(path("a.#.vdb", 123) == "a.123.vdb");
    CHECK(path("a.%03d.vdb", 12345) == "a.12345.vdb");
    CHECK(path("a.%04d.vdb", -5) == "a.-005.vdb");
    CHECK(path("%03d/#2/a.##.vdb", 1) == "%03d/#2/a.01.vdb"); // only the file's name, and there the last
    CHECK(path("a#.##.vdb", 1) == "a#.01.vdb");
    CHECK_FALSE(FramePattern::find("a.vdb"));
    CHECK_FALSE(FramePattern::find("%04d/a.vdb"));
    CHECK_FALSE(FramePattern::find("100%.vdb"));
    for (const char* none : {"%", "%d/", "a%0", "%0d", "%00d", "%10d", "%4", "% d"}) {
        CAPTURE(none);
        CHECK_FALSE(FramePattern::find(none));
    }
    CHECK(path("%%d%d", 1) == "%%d1");
    const std::string places(200000, '#'); // longer than a stack of recursive calls is deep
    CHECK(path(places.c_str(), 7) == std::string(places.size() - 1, '0') + "7");
}

TEST_CASE("the number in a name is the last run of digits") {
    CHECK(lastNumber("shot3_smoke.0042") == "0042");
    CHECK(lastNumber("v2_final") == "2");
    CHECK(lastNumber("17") == "17");
    CHECK_FALSE(lastNumber("smoke"));
}

TEST_CASE("placeholders stand for stem, frame and grid") {
    const Placeholders values{"smoke.0042", "0042", "density"};
    CHECK(fillIn("out/{stem}.vtu", values, "OUT") == "out/smoke.0042.vtu");
    CHECK(fillIn("{grid}/{frame}_{frame}.vtu", values, "OUT") == "density/0042_0042.vtu");
    CHECK(fillIn("plain.vtu", values, "OUT") == "plain.vtu");
    CHECK(fillIn("{other}{}.vtu", values, "OUT") == "{other}{}.vtu");
    CHECK(fillIn("{stem}", {"{frame}", {}, {}}, "OUT") == "{frame}"); // values are not filled in again
    CHECK_THROWS_AS(fillIn("{frame}", {"smoke", {}, {}}, "OUT"), UsageError);
    CHECK_THROWS_AS(fillIn("{grid}", {"smoke", {}, {}}, "OUT"), UsageError);
}
