#pragma once
// Copies of the database while it is in use, and what to do when it is damaged.

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

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

/// Makes one, whole and on the disk when this returns, and drops the oldest beyond `keep`. The
/// database may be open elsewhere. Any thread; takes as long as the file is large. Unavailable:
/// disk.
/// @return the new file: backups/roverd-000012.db. Numbers go up, whatever the clock says.
base::Result<std::filesystem::path> back_up(const std::filesystem::path& database, int keep);

/// For before Store::open. A database that is damaged is set aside (roverd.db.damaged-1, never
/// overwritten), and the newest backup that is whole takes its place; without one the store begins
/// empty. Nothing is done to a file that is whole, in use, of a newer schema or of another program.
/// @return what was done, in a sentence; empty: nothing
std::optional<std::string> rescue(const std::filesystem::path& database);

/// Backs up by itself, on a thread of its own.
class Backups {
 public:
  Backups(std::filesystem::path database, BackupOptions options);
  /// Waits for the copy in progress.
  ~Backups();
  Backups(const Backups&) = delete;
  Backups& operator=(const Backups&) = delete;

 private:
  void run();

  const std::filesystem::path database_;
  const BackupOptions options_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace roverd::store
