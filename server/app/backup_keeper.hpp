#pragma once
// Copies of the database, made by themselves while roverd serves. Each is made by a program of its
// own (roverd backup): what SQLite takes for it would stay with this one for ever, since memory
// that is locked is not given back piece by piece.
//
//   wait ─▶ roverd backup ─▶ made | failed: told ─▶ wait …
//
// It runs at the lowest priority, inherits no descriptor, and ends when this program does.

#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "app/child_process.hpp"
#include "app/options.hpp"
#include "base/result.hpp"
#include "config/settings.hpp"
#include "store/backups.hpp"

namespace roverd {

/// What `roverd backup` does. @return the new file
base::Result<std::filesystem::path> make_backup(const BackupCommand& command);

store::BackupOptions backup_options(const Settings& settings);

class BackupKeeper {
 public:
  /// Why none was made; on a thread of its own.
  using Trouble = std::function<void(const std::string& why)>;

  /// @param program makes one, and says its name in its last line; empty: this one
  BackupKeeper(const std::filesystem::path& data, store::BackupOptions options, Trouble trouble,
               std::vector<std::string> program = {});
  /// Kills the one in progress: it does not count.
  ~BackupKeeper();
  BackupKeeper(const BackupKeeper&) = delete;
  BackupKeeper& operator=(const BackupKeeper&) = delete;

 private:
  void run();
  void wait(base::Duration time);
  void make();
  void ended(const std::string& problem);

  const std::filesystem::path database_;
  const store::BackupOptions options_;
  const Trouble trouble_;
  const std::vector<std::string> program_;
  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_};
  ChildProcess child_{io_};
  std::string made_;
  std::thread thread_;
};

}  // namespace roverd
