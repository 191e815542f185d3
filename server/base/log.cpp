#include "base/log.hpp"

#include <utility>

#include "base/time.hpp"

namespace roverd::base {
namespace {

LogSink& sink() {
  static LogSink instance;
  return instance;
}

void append(std::string& line, const LogField& field) {
  line += ' ';
  line += field.key;
  line += '=';
  if (!field.value.empty() && field.value.find_first_of(" \"=\n\r\t") == std::string::npos) {
    line += field.value;
    return;
  }
  line += '"';
  for (const char c : field.value) {
    if (c == '"' || c == '\\') line += '\\';
    line += (c == '\n' || c == '\r') ? ' ' : c;
  }
  line += '"';
}

}  // namespace

std::string_view to_string(Level level) noexcept {
  switch (level) {
    case Level::Debug:
      return "debug";
    case Level::Info:
      return "info";
    case Level::Warning:
      return "warning";
    case Level::Error:
      return "error";
  }
  return "error";
}

void set_log_sink(LogSink new_sink) {
  sink() = std::move(new_sink);
}

void log(Level level, std::string_view room, std::string_view message,
         std::initializer_list<LogField> fields) {
  if (!sink()) return;
  try {
    std::string line(message);
    for (const auto& field : fields) append(line, field);
    sink()(level, room, line);
  } catch (...) {
    // No memory for a line: whoever tells of that must not fall over it.
    return;
  }
}

bool LogLimit::due() noexcept {
  const std::int64_t now_ns = steady_now().time_since_epoch().count();
  std::int64_t next_ns = next_ns_.load(std::memory_order_relaxed);
  if (now_ns < next_ns) return false;
  const std::int64_t after_ns = now_ns + from_seconds(period_s_).count();
  return next_ns_.compare_exchange_strong(next_ns, after_ns, std::memory_order_relaxed);
}

}  // namespace roverd::base
