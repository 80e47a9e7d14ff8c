// What is left of files that were not finished.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include "io/OutputFile.h"

#include <filesystem>
#include <fstream>

using namespace vdbtet;

TEST_CASE("what a process that was killed has left of a file can be removed, and nothing else is") {
    const test::TempFolder folder;
    for (const char* name : {".vdbtet-123-0.tmp", ".vdbtet-123-11.tmp", ".vdbtet-1234-0.tmp", "o.vtu"})
        std::ofstream(folder.file(name)) << name;
    OutputFile::removeLeft(folder.file("o.vtu"), 123);
    CHECK_FALSE(std::filesystem::exists(folder.file(".vdbtet-123-0.tmp")));
    CHECK_FALSE(std::filesystem::exists(folder.file(".vdbtet-123-11.tmp")));
    CHECK(std::filesystem::exists(folder.file(".vdbtet-1234-0.tmp")));
    CHECK(std::filesystem::exists(folder.file("o.vtu")));
    OutputFile::removeLeft(folder.file("nowhere/o.vtu"), 123); // there is nothing to remove
}
