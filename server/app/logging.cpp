#include "app/logging.hpp"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <spdlog/async.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/log.hpp"

namespace roverd {
namespace {

constexpr std::size_t kQueueLines = 4096;
constexpr std::size_t kFileBytes = 5 * 1024 * 1024;
constexpr std::size_t kFiles = 3;

spdlog::level::level_enum level_of(base::Level level) {
  switch (level) {
    case base::Level::Debug:
      return spdlog::level::debug;
    case base::Level::Info:
      return spdlog::level::info;
    case base::Level::Warning:
      return spdlog::level::warn;
    case base::Level::Error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

std::optional<base::Level> level_from(std::string_view word) {
  for (const auto level :
       {base::Level::Debug, base::Level::Info, base::Level::Warning, base::Level::Error}) {
    if (base::to_string(level) == word) return level;
  }
  return std::nullopt;
}

}  // namespace

base::Result<void> start_logging(const std::filesystem::path& file, const std::string& level) {
  const auto wanted = level_from(level);
  if (!wanted) {
    return base::fail(base::Code::Invalid,
                      "server.log_level must be debug, info, warning or error, not " + level);
  }
  try {
    spdlog::init_thread_pool(kQueueLines, 1);
    const std::vector<spdlog::sink_ptr> sinks{
        std::make_shared<spdlog::sinks::stderr_color_sink_mt>(),
        std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file.string(), kFileBytes, kFiles)};
    auto logger = std::make_shared<spdlog::async_logger>(
        "roverd", sinks.begin(), sinks.end(), spdlog::thread_pool(),
        spdlog::async_overflow_policy::overrun_oldest);
    logger->set_level(level_of(*wanted));
    logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
    logger->flush_on(spdlog::level::warn);
    spdlog::set_default_logger(logger);
    spdlog::flush_every(std::chrono::seconds(2));
    base::set_log_sink(
        [logger](base::Level line_level, std::string_view room, std::string_view line) {
          logger->log(level_of(line_level), "{} {}", room, line);
        });
  } catch (const std::exception& error) {
    return base::fail(base::Code::Unavailable,
                      "cannot write the log " + file.string() + ": " + error.what());
  }
  return {};
}

void stop_logging() {
  base::set_log_sink(nullptr);
  spdlog::shutdown();
}

}  // namespace roverd
