#include "store/database.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include "mission/text.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;
using base::Code;
using base::Error;
using base::Result;

/// Marks the file as ours ("Rovr"), PRAGMA application_id.
constexpr int kApplicationId = 0x526F7672;
/// An outside reader (a backup, the sqlite3 tool) may hold the file that long.
constexpr int kBusyTimeout_ms = 2000;
/// Checking every page takes about 1 ms per MB; larger files are checked after a crash only.
constexpr std::uintmax_t kAlwaysChecked_bytes = 64u << 20;

std::string reason(int number) {
  return std::generic_category().message(number);
}

int pragma_int(SQLite::Database& db, const char* name) {
  return db.execAndGet(std::string("PRAGMA ") + name).getInt();
}

/// Looks without changing anything, not even by creating a file.
Result<void> inspect_path(const fs::path& file) {
  std::error_code ec;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ec)) {
    return base::fail(Code::Unavailable,
                      "the data folder " + folder.string() +
                          (fs::exists(folder, ec) ? " is not a folder" : " does not exist"));
  }
  if (fs::is_directory(file, ec)) {
    return base::fail(Code::Unavailable, file.string() + " is a folder, not a database");
  }
  if (!fs::exists(file, ec) || fs::file_size(file, ec) == 0) return {};
  static constexpr std::string_view kMagic{"SQLite format 3\0", 16};
  std::array<char, 16> start{};
  std::ifstream in(file, std::ios::binary);
  if (!in) return base::fail(Code::Unavailable, "cannot read " + file.string());
  in.read(start.data(), start.size());
  if (std::string_view(start.data(), static_cast<std::size_t>(in.gcount())) != kMagic) {
    return base::fail(Code::Unavailable, file.string() + " is not a database");
  }
  return {};
}

/// Ours, and not newer than this program? Reads only.
Result<int> inspect_schema(SQLite::Database& db, const std::string& file, int newest) {
  const int version = pragma_int(db, "user_version");
  const bool empty = db.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
  if (pragma_int(db, "application_id") != kApplicationId && !(empty && version == 0)) {
    return base::fail(Code::Unavailable, file + " is a database of another program");
  }
  if (version > newest) {
    return base::fail(Code::Unavailable, file + " is of schema " + std::to_string(version) +
                                             ", this program knows up to " +
                                             std::to_string(newest) +
                                             ": start the newer program or another data folder");
  }
  return version;
}

Result<void> check_pages(SQLite::Database& db, const std::string& file) {
  std::string verdict = db.execAndGet("PRAGMA quick_check(1)").getString();
  if (verdict == "ok") return {};
  std::replace(verdict.begin(), verdict.end(), '\n', ' ');  // start-up errors are one line
  return base::fail(Code::Unavailable, "the database " + file + " is damaged: " + verdict);
}

void migrate(SQLite::Database& db, std::span<const Migration> steps, int version) {
  for (const Migration& step : steps) {
    if (step.number <= version) continue;
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    db.exec(step.sql.data());
    db.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
    db.exec("PRAGMA user_version = " + std::to_string(step.number));
    transaction.commit();
  }
}

/// fold(text), for migrations and whoever looks into the file with our program.
void add_fold(SQLite::Database& db) {
  const auto fold = [](sqlite3_context* context, int, sqlite3_value** values) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(values[0]));
    const std::string folded = mission::folded(text == nullptr ? "" : text);
    sqlite3_result_text(context, folded.c_str(), static_cast<int>(folded.size()), SQLITE_TRANSIENT);
  };
  db.createFunction("fold", 1, true, nullptr, fold, nullptr, nullptr, nullptr);
}

void configure(SQLite::Database& db, std::int64_t max_bytes) {
  db.exec("PRAGMA foreign_keys = ON");
  // In WAL a commit is one append and one fsync; FULL makes that fsync happen at every commit.
  db.execAndGet("PRAGMA journal_mode = WAL").getString();
  db.exec("PRAGMA synchronous = FULL");
  db.execAndGet("PRAGMA journal_size_limit = 16777216").getInt64();
  const std::int64_t pages = max_bytes / pragma_int(db, "page_size");
  db.execAndGet("PRAGMA max_page_count = " + std::to_string(pages)).getInt64();
}

}  // namespace

Result<FileLock> FileLock::take(const fs::path& database_file) {
  const std::string path = database_file.string() + ".lock";
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) {
    const int number = errno;
    return base::fail(Code::Unavailable,
                      "cannot write into the data folder: " + path + ": " + reason(number));
  }
  FileLock lock(fd);
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      const int number = errno;
      return base::fail(Code::Unavailable, "cannot lock " + path + ": " + reason(number));
    }
    std::array<char, 32> owner{};
    const ssize_t n = ::pread(fd, owner.data(), owner.size() - 1, 0);
    std::string who = "another roverd";
    if (n > 0) who += " (process " + std::string(owner.data(), static_cast<std::size_t>(n)) + ")";
    return base::fail(Code::Unavailable, database_file.string() + " is in use by " + who);
  }
  // Only for the message above; whether it gets written does not matter.
  const std::string pid = std::to_string(::getpid());
  if (::ftruncate(fd, 0) == 0) {
    [[maybe_unused]] const ssize_t n = ::pwrite(fd, pid.data(), pid.size(), 0);
  }
  return lock;
}

FileLock::~FileLock() {
  if (fd_ >= 0) ::close(fd_);  // the file stays: removing it would race with the next owner
}

Result<std::unique_ptr<Database>> open_database(const fs::path& file,
                                                std::span<const Migration> steps,
                                                std::int64_t max_bytes) {
  if (auto ok = inspect_path(file); !ok) return tl::unexpected<Error>(ok.error());
  auto lock = FileLock::take(file);
  if (!lock) return tl::unexpected<Error>(lock.error());
  const std::string name = file.string();
  const bool check = worth_checking(file);
  auto result = guarded([&]() -> Result<std::unique_ptr<Database>> {
    auto db = std::make_unique<Database>(Database{
        std::move(*lock),
        SQLite::Database(name, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeout_ms),
        FolderWatch(file)});
    if (sqlite3_db_readonly(db->connection.getHandle(), "main") != 0) {
      return base::fail(Code::Unavailable, name + " may not be written: check its permissions");
    }
    const int newest = steps.empty() ? 0 : steps.back().number;
    const auto version = inspect_schema(db->connection, name, newest);
    if (!version) return tl::unexpected<Error>(version.error());
    if (check) {
      if (auto ok = check_pages(db->connection, name); !ok) {
        return tl::unexpected<Error>(ok.error());
      }
    }
    configure(db->connection, max_bytes);
    add_fold(db->connection);
    migrate(db->connection, steps, *version);
    return db;
  });
  if (!result && result.error().detail.find(name) == std::string::npos) {
    result.error().detail = name + ": " + result.error().detail;
  }
  return result;
}

bool worth_checking(const fs::path& file) {
  std::error_code ec;
  const bool crashed = fs::exists(file.string() + "-wal", ec);
  return crashed || !fs::exists(file, ec) || fs::file_size(file, ec) <= kAlwaysChecked_bytes;
}

Error error_from(const SQLite::Exception& problem) {
  std::string detail;
  switch (problem.getErrorCode() & 0xFF) {
    case SQLITE_FULL:
      detail = "the disk is full, nothing was changed";
      break;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      detail = "the database is held by another program, nothing was changed";
      break;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      detail = std::string("the database is damaged: ") + problem.what();
      break;
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      detail = std::string("the database cannot be written: ") + problem.what();
      break;
    case SQLITE_IOERR:
      detail = std::string("the disk failed, nothing was changed: ") + problem.what();
      break;
    default:
      detail = std::string("the store failed, nothing was changed: ") + problem.what();
  }
  return {Code::Unavailable, std::move(detail), {}};
}

}  // namespace roverd::store
