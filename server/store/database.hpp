#pragma once
// The SQLite file itself: opened for this process alone, brought to the newest schema, and its
// exceptions turned into errors.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>

#include "base/result.hpp"
#include "store/folder_watch.hpp"
#include "store/migrations.hpp"

namespace roverd::store {

/// Holds `<file>.lock` (flock), so that a second program on the same data folder is refused. The
/// kernel lets go of it when the process ends, however it ends.
class FileLock {
 public:
  static base::Result<FileLock> take(const std::filesystem::path& database_file);
  FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileLock& operator=(FileLock&&) = delete;
  FileLock(const FileLock&) = delete;
  ~FileLock();

 private:
  explicit FileLock(int fd) : fd_(fd) {}
  int fd_;
};

/// Used by one thread at a time. The lock outlives the connection.
struct Database {
  FileLock lock;
  SQLite::Database connection;
  FolderWatch place;  ///< of the file
};

/// WAL, synchronous=FULL, foreign keys, all of `steps` applied: one transaction each.
/// @param max_bytes growth stops there as on a full disk. Errors: see Store::open.
base::Result<std::unique_ptr<Database>> open_database(const std::filesystem::path& file,
                                                      std::span<const Migration> steps,
                                                      std::int64_t max_bytes);

/// Is every page to be looked at before the file is used? Small ones always, others after a crash.
bool worth_checking(const std::filesystem::path& file);

/// Always Unavailable: what fails here is the disk or the file, never the asker's values.
base::Error error_from(const SQLite::Exception& problem);

/// Runs `work`, which returns a Result, and turns what it throws into an error.
template <class F>
auto guarded(F&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const SQLite::Exception& problem) {
    return tl::unexpected<base::Error>(error_from(problem));
  } catch (const std::exception& problem) {
    return base::fail(base::Code::Unavailable, std::string("the store failed: ") + problem.what());
  }
}

}  // namespace roverd::store
