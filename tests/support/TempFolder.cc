// Makes and removes temporary folders.
#include "support/TempFolder.h"

#include <random>
#include <system_error>

namespace vdbtet::test {

TempFolder::TempFolder() {
    std::random_device random;
    do {
        mPath = std::filesystem::temp_directory_path() / ("vdbtet-test-" + std::to_string(random()));
    } while (!std::filesystem::create_directory(mPath));
}

TempFolder::~TempFolder() {
    std::error_code ignored; // a destructor has nobody to tell
    std::filesystem::remove_all(mPath, ignored);
}

} // namespace vdbtet::test
