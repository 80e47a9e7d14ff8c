/// @file TempFolder.h
/// A folder of its own for a test, gone with it.
#pragma once

#include <filesystem>
#include <string>

namespace vdbtet::test {

class TempFolder {
public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::string file(const std::string& name) const { return (mPath / name).string(); }

private:
    std::filesystem::path mPath;
};

} // namespace vdbtet::test
