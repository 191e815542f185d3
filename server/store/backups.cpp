#include "store/backups.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include "store/database.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;
using base::Code;
using base::Result;

constexpr std::string_view kFront = "roverd-";
constexpr std::string_view kEnd = ".db";
constexpr const char* kUnfinished = "unfinished";
/// What belongs to one database.
constexpr std::array<const char*, 3> kParts{"", "-wal", "-shm"};

/// By number, oldest first.
std::map<int, fs::path> backups_in(const fs::path& folder) {
  std::map<int, fs::path> out;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(folder, ec)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kFront) || !name.ends_with(kEnd)) continue;
    int number = 0;
    const char* end = name.data() + name.size() - kEnd.size();
    const auto read = std::from_chars(name.data() + kFront.size(), end, number);
    if (read.ec == std::errc{} && read.ptr == end) out.emplace(number, entry.path());
  }
  return out;
}

/// The file's bytes, or a folder's names, are on the disk.
bool sync(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool done = ::fsync(fd) == 0;
  ::close(fd);
  return done;
}

/// Held by whoever makes a backup.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ < 0) {
      problem_ = folder.string() + ": " + std::generic_category().message(errno);
    } else if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      problem_ = "another backup is being made";
    }
  }
  ~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  const std::string& problem() const noexcept { return problem_; }  ///< empty: it is held

 private:
  int fd_;
  std::string problem_;
};

/// Why the file is no database any more; empty: it is one, or nobody knows.
/// @param every_page takes about 1 ms per MB; else the beginning alone
std::string damage_of(const fs::path& file, bool every_page = true) {
  std::error_code ec;
  if (!fs::is_regular_file(file, ec) || fs::file_size(file, ec) == 0 || ec) return {};
  try {
    SQLite::Database db(file.string(), SQLite::OPEN_READWRITE, 2000);
    db.execAndGet("SELECT count(*) FROM sqlite_schema").getInt();
    if (!every_page) return {};
    const std::string verdict = db.execAndGet("PRAGMA quick_check(1)").getString();
    return verdict == "ok" ? std::string() : verdict;
  } catch (const SQLite::Exception& problem) {
    const int code = problem.getErrorCode() & 0xFF;
    const bool damaged = code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
    return damaged ? std::string(problem.what()) : std::string();
  }
}

/// roverd.db.damaged-1, with what belongs to it. @return empty: it could not be moved.
fs::path set_aside(const fs::path& file) {
  std::error_code ec;
  for (int i = 1; i < 10'000; ++i) {
    fs::path target = file.string() + ".damaged-" + std::to_string(i);
    if (fs::exists(target, ec)) continue;
    fs::rename(file, target, ec);
    if (ec) return {};
    for (const char* part : kParts) {
      if (*part != '\0') fs::rename(file.string() + part, target.string() + part, ec);
    }
    return target;
  }
  return {};
}

/// @return its name; empty: there is none that is whole.
std::string bring_back(const fs::path& file) {
  const auto known = backups_in(backup_folder(file));
  for (auto at = known.rbegin(); at != known.rend(); ++at) {
    if (!damage_of(at->second).empty()) continue;
    const fs::path copy = file.string() + ".restored";
    std::error_code ec;
    fs::copy_file(at->second, copy, fs::copy_options::overwrite_existing, ec);
    if (ec || !sync(copy)) continue;
    fs::rename(copy, file, ec);
    if (!ec) return at->second.filename().string();
  }
  return {};
}

/// Where they lie, made if only that is missing.
Result<fs::path> folder_for(const fs::path& database) {
  fs::path folder = backup_folder(database);
  std::error_code ec;
  fs::create_directory(folder, ec);
  if (ec) return base::fail(Code::Unavailable, folder.string() + ": " + ec.message());
  return folder;
}

fs::path next_name(const fs::path& folder, const std::map<int, fs::path>& known) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%06d",
                known.empty() ? 1 : known.rbegin()->first + 1);
  return folder / (std::string(kFront) + digits.data() + std::string(kEnd));
}

/// Every page of the copy is looked at.
Result<void> copy_into(const fs::path& database, const fs::path& copy) {
  return guarded([&]() -> Result<void> {
    {
      SQLite::Database db(database.string(), SQLite::OPEN_READONLY, 2000);
      // Pages pass by once, here and in the copy: more of them at a time would be no faster.
      db.exec("PRAGMA cache_size = -256");
      SQLite::Statement vacuum(db, "VACUUM INTO ?");
      vacuum.bind(1, copy.string());
      vacuum.exec();
    }
    SQLite::Database made(copy.string(), SQLite::OPEN_READONLY);
    made.exec("PRAGMA cache_size = -256");
    const std::string verdict = made.execAndGet("PRAGMA quick_check(1)").getString();
    if (verdict == "ok") return {};
    return base::fail(Code::Unavailable, "the copy is not whole: " + verdict);
  });
}

void drop_beyond(int keep, const std::map<int, fs::path>& known) {
  const std::size_t most = static_cast<std::size_t>(std::max(keep, 1)) - 1;  // and the new one
  auto oldest = known.begin();
  for (std::size_t count = known.size(); count > most; --count) {
    std::error_code ec;
    fs::remove((oldest++)->second, ec);
  }
}

}  // namespace

fs::path backup_folder(const fs::path& database) {
  return (database.has_parent_path() ? database.parent_path() : fs::path(".")) / "backups";
}

Result<fs::path> back_up(const fs::path& database, int keep) {
  const auto folder = folder_for(database);
  if (!folder) return folder;
  const FolderLock lock(*folder);
  if (!lock.problem().empty()) return base::fail(Code::Unavailable, lock.problem());
  std::error_code ec;
  if (!fs::exists(database, ec)) {
    return base::fail(Code::Unavailable, "there is no database " + database.string());
  }
  const auto known = backups_in(*folder);
  const fs::path target = next_name(*folder, known);
  const fs::path unfinished = *folder / kUnfinished;
  fs::remove(unfinished, ec);
  if (const auto done = copy_into(database, unfinished); !done) {
    fs::remove(unfinished, ec);
    return tl::unexpected(done.error());
  }
  // Only what is on the disk gets the name of a backup.
  const bool kept = sync(unfinished);
  if (kept) fs::rename(unfinished, target, ec);
  if (!kept || ec || !sync(*folder)) {
    fs::remove(unfinished, ec);
    return base::fail(Code::Unavailable, "the disk did not keep " + target.string());
  }
  drop_beyond(keep, known);
  return target;
}

void drop_unfinished(const fs::path& database) {
  const fs::path folder = backup_folder(database);
  const FolderLock lock(folder);
  if (!lock.problem().empty()) return;
  std::error_code ec;
  for (const char* part : kParts) fs::remove((folder / kUnfinished).string() + part, ec);
}

base::Duration first_backup_in(const fs::path& database, const BackupOptions& options) {
  const auto known = backups_in(backup_folder(database));
  if (known.empty()) return options.first;
  std::error_code ec;
  const auto age =
      fs::file_time_type::clock::now() - fs::last_write_time(known.rbegin()->second, ec);
  if (ec || age < age.zero() || age >= options.period) return options.first;
  return std::max<base::Duration>(options.first,
                                  options.period - std::chrono::duration_cast<base::Duration>(age));
}

std::optional<std::string> rescue(const fs::path& database) {
  std::error_code ec;
  if (!fs::exists(database, ec)) return std::nullopt;
  const auto lock = FileLock::take(database);
  if (!lock) return std::nullopt;  // in use, or nobody may write here: Store::open says which
  const std::string damage = damage_of(database, worth_checking(database));
  if (damage.empty()) return std::nullopt;
  const fs::path aside = set_aside(database);
  if (aside.empty()) return std::nullopt;
  const std::string backup = bring_back(database);
  std::string told = "the database was damaged (" + damage + ") and was set aside as " +
                     aside.filename().string() + "; ";
  told += backup.empty() ? "there is no backup: missions, runs and changed parameters begin anew"
                         : "the backup " + backup +
                               " took its place: what came after it is only in "
                               "the damaged file";
  std::replace(told.begin(), told.end(), '\n', ' ');
  return told;
}

}  // namespace roverd::store
