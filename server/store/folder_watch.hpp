#pragma once
// Is what was opened still there? A file that was removed can be written for ever, and nothing of
// it is kept; a disk fills up, or becomes read-only.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/time.hpp"

namespace roverd::store {

/// As the store's thread saw it last.
struct StorageState {
  base::Time looked{};                        ///< old: the disk does not answer
  std::string trouble{};                      ///< why nothing is kept; empty: all is well
  std::optional<std::uint64_t> free_bytes{};  ///< for this program, on the folder's disk
};

/// One thread at a time. Each call is two or three system calls.
class FolderWatch {
 public:
  /// @param file that is open
  explicit FolderWatch(std::filesystem::path file);

  /// Empty: the file's name still leads to the file that was opened.
  std::string gone() const;
  /// Empty: a new file could be made in its folder.
  std::string unwritable() const;
  std::optional<std::uint64_t> free_bytes() const;

 private:
  std::filesystem::path file_;
  std::filesystem::path folder_;
  bool known_ = false;
  std::uint64_t device_ = 0;
  std::uint64_t inode_ = 0;
};

}  // namespace roverd::store
