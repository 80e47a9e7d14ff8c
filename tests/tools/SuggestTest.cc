// Mistyped words.
#include "support/Catch.h"

#include "Suggest.h"

TEST_CASE("the edit distance counts insertions, deletions, changes and swaps") {
    CHECK(editDistance("spacing", "spacing") == 0);
    CHECK(editDistance("sapcing", "spacing") == 1);
    CHECK(editDistance("spacng", "spacing") == 1);
    CHECK(editDistance("spaacing", "spacing") == 1);
    CHECK(editDistance("spaking", "spacing") == 1);
    CHECK(editDistance("", "abc") == 3);
    CHECK(editDistance("abc", "") == 3);
    CHECK(editDistance("kitten", "sitting") == 3);
}

TEST_CASE("the nearest word is suggested, and none that is far off") {
    const std::vector<std::string> known = {"--spacing", "--sample", "--scale", "--resume"};
    CHECK(nearestWord("--sapcing", known) == "--spacing");
    CHECK(nearestWord("--spacings", known) == "--spacing");
    CHECK(nearestWord("--resmue", known) == "--resume");
    CHECK(nearestWord("--nonsense", known).empty());
    CHECK(nearestWord("--spacing", {}).empty());
}
