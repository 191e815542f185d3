#pragma once
// `roverd report [--data DIR] RUN...`: how well runs were driven, side by side, as a table.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace roverd {

/// Reads the database in the folder itself, so it works with and without a running program.
/// @param runs at least one. @return exit code: 0; 1 the database cannot be read; 2 no such run
int report(const std::filesystem::path& data, const std::vector<std::int64_t>& runs);

}  // namespace roverd
