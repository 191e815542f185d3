#pragma once
// Copies of the database while it is in use, and what to do when it is damaged.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.hpp"
#include "base/time.hpp"

namespace roverd::store {

struct BackupOptions {
  int keep = 7;  ///< the newest so many; 0: none are made
  base::Duration period = std::chrono::hours(24);
  /// After the start, unless one was made within the period.
  base::Duration first = std::chrono::minutes(10);
};

/// Where the copies of a database lie: "backups" beside it.
std::filesystem::path backup_folder(const std::filesystem::path& database);

/// Makes one, whole and on the disk when this returns, and drops the oldest beyond `keep`. Until
/// then it has another name, which no backup has. The database may be open elsewhere. Any thread;
/// takes as long as the file is large. Unavailable: disk, or another one is being made.
/// @return the new file: backups/roverd-000012.db. Numbers go up, whatever the clock says.
base::Result<std::filesystem::path> back_up(const std::filesystem::path& database, int keep);

/// Removes what one that was killed has left. Nothing is done while another one is being made.
void drop_unfinished(const std::filesystem::path& database);

/// From now, at the start: a clock that was set back makes the newest one lie in the future; then
/// one more is made.
base::Duration first_backup_in(const std::filesystem::path& database, const BackupOptions& options);

/// For before Store::open. A database that is damaged is set aside (roverd.db.damaged-1, never
/// overwritten), and the newest backup that is whole takes its place; without one the store begins
/// empty. Nothing is done to a file that is whole, in use, of a newer schema or of another program.
/// @return what was done, in a sentence; empty: nothing
std::optional<std::string> rescue(const std::filesystem::path& database);

}  // namespace roverd::store
