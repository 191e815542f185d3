#pragma once
// The words of the log; the writing (asynchronous) is wired in by the program's main function.
// nav and mission never log: they return reasons. Never called from Robot::tick.

#include <atomic>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

namespace roverd::base {

enum class Level { Debug, Info, Warning, Error };
std::string_view to_string(Level level) noexcept;

struct LogField {
  std::string_view key;
  std::string value;
};

/// Line: time level room message key=value …
using LogSink = std::function<void(Level, std::string_view room, std::string_view line)>;

/// Set once, before threads start. Without a sink, lines go nowhere.
void set_log_sink(LogSink sink);

/// Any thread but the control loop. Values with blanks or quotes are quoted.
void log(Level level, std::string_view room, std::string_view message,
         std::initializer_list<LogField> fields = {});

/// At most one line a period from one call site; keep a static instance there.
class LogLimit {
 public:
  explicit LogLimit(double period_s) : period_s_(period_s) {}
  /// @return true if the caller may log now. Thread-safe.
  bool due() noexcept;

 private:
  const double period_s_;
  std::atomic<std::int64_t> next_ns_{0};
};

}  // namespace roverd::base
