// roverd: reads what it is told, starts the station, serves until a signal comes. Or decodes a
// recording (decode.hpp), plays one through the estimator (replay_run.hpp), or becomes the program
// that studies in simulated time (study.hpp).

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "app/backup_keeper.hpp"
#include "app/drill.hpp"
#include "app/logging.hpp"
#include "app/memory_reserve.hpp"
#include "app/options.hpp"
#include "app/station.hpp"
#include "base/log.hpp"
#include "base/result.hpp"
#include "config/settings.hpp"
#include "replay/run.hpp"
#include "robot/config.hpp"
#include "store/backups.hpp"
#include "store/store.hpp"
#include "tools/decode.hpp"
#include "tools/failsafes.hpp"
#include "tools/locate.hpp"
#include "tools/maps.hpp"
#include "tools/ntrip_table.hpp"
#include "tools/report.hpp"

namespace {

namespace base = roverd::base;

/// Exit codes: 1 something on this machine refuses (port, folder, database), 2 wrong arguments or
/// configuration.
constexpr int kRefused = 1;
constexpr int kWrongInput = 2;

int say(int code, const std::string& cause) {
  std::fprintf(stderr, "roverd: %s\n", cause.c_str());
  return code;
}

/// What was said wrongly, or what this machine refuses?
int exit_code(base::Code code) {
  switch (code) {
    case base::Code::Malformed:
    case base::Code::Invalid:
    case base::Code::NotFound:
    case base::Code::Unsupported:
      return kWrongInput;
    case base::Code::Conflict:
    case base::Code::RevisionMismatch:
    case base::Code::PreconditionMissing:
    case base::Code::TooLarge:
    case base::Code::Unavailable:
    case base::Code::Late:
      break;
  }
  return kRefused;
}

/// What somebody looked at before it came to the robot: profile and file. Alone they may make no
/// whole: then what stands there together with the command line.
roverd::robot::Config reviewed(const roverd::Options& options, const roverd::Settings& all) {
  auto files = roverd::load_settings(
      {.config = options.config, .vehicle = options.vehicle, .overrides = {}});
  return files ? files->robot : all.robot;
}

/// What was changed while the program ran holds over the files, not over the command line. A value
/// that this version does not take any more is left out, and said.
std::vector<std::string> take_kept_parameters(roverd::Settings& settings,
                                              const std::filesystem::path& database) {
  std::vector<roverd::robot::NamedValue> kept;
  for (auto& one : roverd::store::read_parameters(database)) {
    const auto place = settings.places.find(one.name);
    if (place != settings.places.end() && place->second.starts_with("--set ")) continue;
    kept.emplace_back(std::move(one.name), std::move(one.value));
  }
  return roverd::robot::take_kept(settings.robot, std::move(kept));
}

constexpr mode_t kOwnerAlone = S_IRWXG | S_IRWXO;

/// In the database are hashes of passwords; an older version let others read it.
void close_to_others(const std::filesystem::path& data) {
  namespace fs = std::filesystem;
  constexpr auto kOthers = fs::perms::group_all | fs::perms::others_all;
  std::error_code ec;
  std::vector<fs::path> files;
  for (const char* ending : {"", "-wal", "-shm"}) {
    files.push_back(data / (std::string("roverd.db") + ending));
  }
  for (const auto& one : fs::directory_iterator(data / "backups", ec)) files.push_back(one.path());
  for (const auto& file : files) {
    if (!fs::is_regular_file(fs::symlink_status(file, ec))) continue;
    fs::permissions(file, kOthers, fs::perm_options::remove, ec);
  }
}

int serve(const roverd::Options& options) {
  ::umask(kOwnerAlone);
  roverd::hold_memory_back();
  auto overrides = options.overrides;
  if (options.tls) overrides.emplace_back("server.tls=true");
  if (options.lan) overrides.emplace_back("server.listen=lan");
  auto settings = roverd::load_settings(
      {.config = options.config, .vehicle = options.vehicle, .overrides = std::move(overrides)});
  if (!settings) return say(kWrongInput, settings.error().detail);
  settings->reviewed = reviewed(options, *settings);
  std::error_code ec;
  std::filesystem::create_directories(options.data, ec);
  if (ec) return say(kRefused, "data folder " + options.data + ": " + ec.message());
  const auto log_file = std::filesystem::path(options.data) / "roverd.log";
  if (auto logging = roverd::start_logging(log_file, settings->server.log_level); !logging) {
    return say(kRefused, logging.error().detail);
  }
  close_to_others(options.data);
  const auto database = std::filesystem::path(options.data) / "roverd.db";
  // Before its parameters are read: they may come from the backup.
  if (auto told = roverd::store::rescue(database)) {
    base::log(base::Level::Error, "main", "damaged database", {{"done", *told}});
    settings->rescued = std::move(*told);
  }
  settings->left_out = take_kept_parameters(*settings, database);
  for (const std::string& why : settings->left_out) {
    base::log(base::Level::Warning, "main", "a kept parameter is left out", {{"reason", why}});
  }
  {
    auto station = roverd::Station::open(*settings, options);
    if (!station) {
      roverd::stop_logging();
      return say(exit_code(station.error().code), station.error().detail);
    }
    std::printf("listening on %s\n", (*station)->address().c_str());
    std::printf("%s", (*station)->invitation(::isatty(STDOUT_FILENO) == 1).c_str());
    std::fflush(stdout);
    (*station)->run();
  }
  roverd::stop_logging();
  return 0;
}

int back_up(const roverd::BackupCommand& command) {
  ::umask(kOwnerAlone);
  const auto made = roverd::make_backup(command);
  if (!made) return say(kRefused, "backup: " + made.error().detail);
  std::printf("%s\n", made->c_str());
  return 0;
}

int become_study(char** argv) {
  const std::string program = roverd::study_program();
  ::execv(program.c_str(), argv + 1);
  return say(kRefused, program + ": " + std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // The study's arguments are its own.
    if (argc > 1 && std::string_view(argv[1]) == "study") return become_study(argv);
    struct Run {
      int operator()(const roverd::Options& o) const { return serve(o); }
      int operator()(const roverd::DecodeCommand& c) const {
        return roverd::decode(c.kind, c.file);
      }
      int operator()(const roverd::ReplayCommand& c) const { return roverd::replay(c); }
      int operator()(const roverd::ReportCommand& c) const {
        return roverd::report(c.data, c.runs);
      }
      int operator()(const roverd::TableCommand& c) const {
        return roverd::ntrip_table(c.casters, c.json);
      }
      int operator()(const roverd::BackupCommand& c) const { return back_up(c); }
      int operator()(const roverd::FailsafesCommand& c) const { return roverd::failsafes(c.into); }
      int operator()(const roverd::AlignCommand& c) const { return roverd::align_clouds(c); }
      int operator()(const roverd::MapCommand& c) const { return roverd::make_map(c); }
      int operator()(const roverd::LocateCommand& c) const { return roverd::locate(c); }
    };
    return std::visit(Run{}, roverd::read_command(argc, argv));
  } catch (const std::exception& error) {
    return say(kRefused, error.what());
  }
}
