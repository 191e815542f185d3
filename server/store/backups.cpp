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
#include <unistd.h>

#include "base/log.hpp"
#include "store/database.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;
using base::Code;
using base::Result;

constexpr std::string_view kFront = "roverd-";
constexpr std::string_view kEnd = ".db";
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

}  // namespace

fs::path backup_folder(const fs::path& database) {
  return (database.has_parent_path() ? database.parent_path() : fs::path(".")) / "backups";
}

Result<fs::path> back_up(const fs::path& database, int keep) {
  const fs::path folder = backup_folder(database);
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec) return base::fail(Code::Unavailable, folder.string() + ": " + ec.message());
  const auto known = backups_in(folder);
  const int number = known.empty() ? 1 : known.rbegin()->first + 1;
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), "%06d", number);
  const fs::path target = folder / (std::string(kFront) + digits.data() + std::string(kEnd));
  const fs::path unfinished = folder / "unfinished";
  fs::remove(unfinished, ec);
  auto done = guarded([&]() -> Result<fs::path> {
    SQLite::Database db(database.string(), SQLite::OPEN_READONLY, 2000);
    // Pages pass by once, here and in the copy: more would stay with this thread's heap, 4 MB of
    // it.
    db.exec("PRAGMA cache_size = -256");
    SQLite::Statement copy(db, "VACUUM INTO ?");
    copy.bind(1, unfinished.string());
    copy.exec();
    return target;
  });
  if (!done) {
    fs::remove(unfinished, ec);
    return done;
  }
  fs::rename(unfinished, target, ec);
  if (ec || !sync(target) || !sync(folder)) {
    return base::fail(Code::Unavailable, "the disk did not keep " + target.string());
  }
  const std::size_t spare =
      known.size() + 1 - std::min(known.size() + 1, static_cast<std::size_t>(std::max(keep, 1)));
  auto oldest = known.begin();
  for (std::size_t i = 0; i < spare; ++i) fs::remove((oldest++)->second, ec);
  return done;
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

Backups::Backups(fs::path database, BackupOptions options)
    : database_(std::move(database)), options_(options) {
  if (options_.keep > 0) thread_ = std::thread([this] { run(); });
}

Backups::~Backups() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  end_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Backups::run() {
  // A clock that was set back makes the newest one lie in the future: then one more is made.
  std::error_code ec;
  base::Duration wait = options_.first;
  if (const auto known = backups_in(backup_folder(database_)); !known.empty()) {
    const auto age =
        fs::file_time_type::clock::now() - fs::last_write_time(known.rbegin()->second, ec);
    if (!ec && age >= age.zero() && age < options_.period) {
      wait = std::max<base::Duration>(
          wait, options_.period - std::chrono::duration_cast<base::Duration>(age));
    }
  }
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (end_.wait_for(lock, wait, [this] { return ending_; })) return;
    }
    const auto made = back_up(database_, options_.keep);
    base::log(made ? base::Level::Info : base::Level::Warning, "store",
              made ? "backed up" : "no backup could be made",
              {{made ? "file" : "reason", made ? made->string() : made.error().detail}});
    wait = options_.period;
  }
}

}  // namespace roverd::store
