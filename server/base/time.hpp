#pragma once
// Time, for every room. Two kinds, and no arithmetic between them:
//   Time      a point on the machine's monotonic clock; control, measurements, ages.
//   WallTime  UTC; only for people: events, file stamps, API answers.
// Time is an argument everywhere. Only the loop thread, links, the web's timers and the
// programs' main functions read a clock (steady_now, wall_now); mission and nav never do.

#include <chrono>
#include <cstdint>
#include <string>

namespace roverd::base {

using Duration = std::chrono::nanoseconds;

/// Tag for the monotonic clock. It has no now(): a test hands in any time it likes.
struct MonotonicClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MonotonicClock, duration>;
  static constexpr bool is_steady = true;
};

using Time = MonotonicClock::time_point;
using WallTime = std::chrono::sys_time<Duration>;

/// 2025-01-01T00:00:00Z: this program is younger. A clock before it was never set.
inline constexpr WallTime kYoungest{std::chrono::seconds(1'735'689'600)};

/// CLOCK_MONOTONIC. Thread-safe, does not allocate.
Time steady_now() noexcept;
/// CLOCK_REALTIME as UTC. Thread-safe, does not allocate.
WallTime wall_now() noexcept;

/// Seconds as a double; exact to 1 ns below 50 days.
constexpr double seconds(Duration d) noexcept {
  return std::chrono::duration<double>(d).count();
}
/// Rounded towards zero to whole nanoseconds. @param s any finite number of seconds below 290
/// years.
constexpr Duration from_seconds(double s) noexcept {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s));
}

/// RFC 3339 in UTC with milliseconds: 2026-03-01T12:00:00.250Z. Rounds down.
std::string to_rfc3339(WallTime t);

}  // namespace roverd::base
