#pragma once
// That a map is being made by driving outlives this process, the drive does not: the next start
// tells that it is gone, instead of a list of maps in which one is missing.
//
//   begun() ─▶ a file of one line: when ─▶ ended() takes it away; left over: found() by the next
//
// Kept as well as the disk lets it: without room for it nothing is told after a restart. The web's
// and its workers' threads, one call at a time.

#include <filesystem>
#include <optional>
#include <string>

#include "base/time.hpp"

namespace roverd {

class DrawingMark {
 public:
  explicit DrawingMark(std::filesystem::path file) : file_(std::move(file)) {}

  /// Once at the start: a sentence for people where one was being made as the last program ended.
  std::optional<std::string> found();
  void begun(base::WallTime now) noexcept;
  void ended() noexcept;

 private:
  const std::filesystem::path file_;
};

}  // namespace roverd
