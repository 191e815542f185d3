#pragma once
// The failsafes, one row each: what is seen, after what, what follows, how it ends, who may
// override.
//
//   facts, parameters, time ─▶ every row's test ─▶ what it tells, or nothing     (assess,
//   safety.hpp)
//                              the strongest response wins, all are shown in the order of the table
//
// To add one: a row in the table of its theme (failsafes_base.cpp, _operator.cpp, …),
// what it needs to know in Facts, and `roverd failsafes --into docs/safety.md`. Rows of one id
// stand together, the stronger first: only the first that tells something is shown and counts.
//
// Pure, any thread. A row's texts are for docs/safety.md; what people see while driving is what its
// test says.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "robot/config.hpp"
#include "robot/safety/facts.hpp"

namespace roverd::robot {

/// Later ones win. Slow: creep. Return: RTL, where it is possible, else Hold; whoever is on his way
/// home or to the dock goes on. Hold: stop, mode HOLD, until an operator goes on. Disarm: that, and
/// disarmed. Stop: the latched emergency stop.
enum class Response { None, Warn, Slow, Return, Hold, Disarm, Stop };
std::string_view to_string(Response r) noexcept;  // show warn slow return …

/// When the response follows. At other times the row is shown and nothing follows.
enum class Acts { Always, ByItself, ByHand };
std::string_view to_string(Acts a) noexcept;  // always by_itself by_hand

struct MadeUp;

struct Failsafe {
  std::string_view id;    ///< of the condition
  std::string_view seen;  ///< "the base is silent"
  /// "{base_timeout_s}": so much is named by a parameter of robot.safety. "at once".
  std::string_view after;
  Response response = Response::None;
  Acts acts = Acts::Always;
  std::string_view ends;  ///< what ends it
  std::string_view over;  ///< who may override it
  /// What is seen now, in words for people; empty: nothing is.
  std::optional<std::string> (*test)(const Facts& facts, const SafetyParams& p, Time now) = nullptr;
  /// Makes it so that `test` must tell something: for the self-test.
  void (*provoke)(MadeUp& world) = nullptr;
  std::string_view watched_by = {};  ///< without a test: which file sees it and acts
};

/// All of them, in the order in which they are shown.
std::span<const Failsafe> failsafes() noexcept;

/// Whether a row that tells something now is followed by its response now.
bool acts_now(const Failsafe& row, const Facts& facts, const SafetyParams& p, Time now) noexcept;

// By theme; failsafes() is these, one after the other.
std::span<const Failsafe> base_failsafes() noexcept;
std::span<const Failsafe> operator_failsafes() noexcept;
std::span<const Failsafe> sensor_failsafes() noexcept;
std::span<const Failsafe> position_failsafes() noexcept;
std::span<const Failsafe> supply_failsafes() noexcept;
/// Seen and acted on elsewhere; here for the list's sake.
std::span<const Failsafe> failsafes_elsewhere() noexcept;

}  // namespace roverd::robot
