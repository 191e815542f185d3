// roverd: reads what it is told, starts the station, serves until a signal comes. Or decodes a
// recording (decode.hpp), or plays one through the estimator (replay_run.hpp).

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "base/result.hpp"
#include "decode.hpp"
#include "logging.hpp"
#include "options.hpp"
#include "replay_run.hpp"
#include "settings.hpp"
#include "station.hpp"

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

int serve(const roverd::Options& options) {
  const auto settings = roverd::load_settings(
      {.config = options.config, .vehicle = options.vehicle, .overrides = options.overrides});
  if (!settings) return say(kWrongInput, settings.error().detail);
  std::error_code ec;
  std::filesystem::create_directories(options.data, ec);
  if (ec) return say(kRefused, "data folder " + options.data + ": " + ec.message());
  const auto log_file = std::filesystem::path(options.data) / "roverd.log";
  if (auto logging = roverd::start_logging(log_file, settings->server.log_level); !logging) {
    return say(kRefused, logging.error().detail);
  }
  {
    auto station = roverd::Station::open(*settings, options);
    if (!station) {
      roverd::stop_logging();
      return say(exit_code(station.error().code), station.error().detail);
    }
    std::printf("listening on %s\n", (*station)->address().c_str());
    std::fflush(stdout);
    (*station)->run();
  }
  roverd::stop_logging();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1 && std::string_view(argv[1]) == "decode")
      return roverd::decode(argc - 2, argv + 2);
    if (argc > 1 && std::string_view(argv[1]) == "replay")
      return roverd::replay(argc - 2, argv + 2);
    return serve(roverd::read_options(argc, argv));
  } catch (const std::exception& error) {
    return say(kRefused, error.what());
  }
}
