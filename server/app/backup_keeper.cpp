#include "app/backup_keeper.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/log.hpp"

namespace roverd {

namespace {

namespace fs = std::filesystem;

/// 2 GB on a slow card, beside all else.
constexpr base::Duration kLongestBackup = std::chrono::minutes(30);
constexpr const char* kDatabase = "roverd.db";
constexpr int kLast = 19;  ///< the last place among ordinary processes, for processor and disk

std::vector<std::string> this_program(const fs::path& data, int keep) {
  std::error_code ec;
  return {fs::read_symlink("/proc/self/exe", ec).string(),
          "backup",
          "--data",
          data.string(),
          "--keep",
          std::to_string(keep),
          "--ends-with",
          std::to_string(::getpid())};
}

/// @return false: it has ended already.
bool end_with(int parent) {
  return ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && ::getppid() == parent;
}

}  // namespace

base::Result<fs::path> make_backup(const BackupCommand& command) {
  if (command.ends_with != 0 && !end_with(command.ends_with)) {
    return base::fail(base::Code::Unavailable,
                      "process " + std::to_string(command.ends_with) + " has not started this one");
  }
  ::setpriority(PRIO_PROCESS, 0, kLast);
  return store::back_up(fs::path(command.data) / kDatabase, command.keep);
}

store::BackupOptions backup_options(const Settings& settings) {
  return {.keep = settings.backups.keep,
          .period = std::chrono::hours(settings.backups.every_h),
          .first = std::chrono::seconds(settings.backups.first_s)};
}

BackupKeeper::BackupKeeper(const fs::path& data, store::BackupOptions options, Trouble trouble,
                           std::vector<std::string> program)
    : database_(data / kDatabase),
      options_(options),
      trouble_(std::move(trouble)),
      program_(program.empty() ? this_program(data, options.keep) : std::move(program)),
      thread_([this] { run(); }) {}

BackupKeeper::~BackupKeeper() {
  io_.stop();
  thread_.join();
}

void BackupKeeper::run() {
  store::drop_unfinished(database_);
  wait(store::first_backup_in(database_, options_));
  for (;;) {
    try {
      io_.run();
      return;
    } catch (const std::exception& error) {  // no memory: again in a day
      base::log(base::Level::Error, "store", "no backup could be made", {{"reason", error.what()}});
      child_.stop();
      wait(options_.period);
    }
  }
}

void BackupKeeper::wait(base::Duration time) {
  timer_.expires_after(time);
  timer_.async_wait([this](const boost::system::error_code& ec) {
    if (!ec) make();
  });
}

void BackupKeeper::make() {
  made_.clear();
  const auto begun = child_.start(program_, "", kLongestBackup,
                                  {.line = [this](const std::string& line) { made_ = line; },
                                   .end = [this](const std::string& problem) { ended(problem); }});
  if (!begun) ended(begun.error().detail);
}

void BackupKeeper::ended(const std::string& problem) {
  wait(options_.period);
  if (problem.empty()) {
    base::log(base::Level::Info, "store", "backed up", {{"file", made_}});
    return;
  }
  base::log(base::Level::Warning, "store", "no backup could be made", {{"reason", problem}});
  store::drop_unfinished(database_);
  trouble_("no backup could be made: " + problem);
}

}  // namespace roverd
