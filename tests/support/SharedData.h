/// @file SharedData.h
/// Finds the data that lies beside the source tree, in the folder that VDBTET_SHARED names or in ../shared.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vdbtet::test {

/// @return the path below the shared folder. Where it is missing: nothing, and a warning that says
/// "SKIPPED", by which ctest marks the test as skipped.
std::optional<std::filesystem::path> sharedPath(const std::string& below);

} // namespace vdbtet::test
