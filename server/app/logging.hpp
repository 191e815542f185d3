#pragma once
// Writes the log: asynchronous (a bounded queue that drops the oldest line, so that a full disk or
// a slow terminal never holds anybody up), to standard error and to a rotating file.

#include <filesystem>
#include <string>

#include "base/result.hpp"

namespace roverd {

/// Starts logging for the whole program. @param level debug, info, warning or error.
base::Result<void> start_logging(const std::filesystem::path& file, const std::string& level);
/// Writes out what is queued.
void stop_logging();

}  // namespace roverd
