// Looks for the shared folder, and says so loudly when there is none.
#include "support/SharedData.h"

#include "support/Catch.h"

#include <cstdlib>

namespace vdbtet::test {

std::optional<std::filesystem::path> sharedPath(const std::string& below) {
    const char* named = std::getenv("VDBTET_SHARED");
    const std::filesystem::path folder =
        named ? std::filesystem::path(named) : std::filesystem::path(VDBTET_SOURCE_DIR) / ".." / "shared";
    const std::filesystem::path path = folder / below;
    if (std::filesystem::exists(path)) return path;
    WARN("SKIPPED: there is no " << path.string() << "; set VDBTET_SHARED to the shared folder");
    return {};
}

} // namespace vdbtet::test
