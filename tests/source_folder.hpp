#pragma once
// Where the sources lie that this was built from, with what belongs to them. Only this one place
// knows it: all other objects are the same for every checkout of the same sources, and are compiled
// once for all.

#include <filesystem>
#include <string_view>

namespace roverd::tests {

/// Absolute.
std::filesystem::path source_folder();

/// A file of the repository: in_source("config/robot.toml").
std::filesystem::path in_source(std::string_view name);

}  // namespace roverd::tests
