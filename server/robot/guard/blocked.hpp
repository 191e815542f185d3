#pragma once
// What becomes of a drive by itself that the guard has stopped for too long. Section
// [sense.blocked].
//
//   Clear ──the guard stops it──▶ Waits ──after_s──▶ Blocked: `then` is told, once
//     ▲                             │                   │
//     └──── the way is clear, or something else is done ┘
//
// A way that is clear for a moment only, and on which the robot comes no farther, ends nothing: the
// time runs on. Pure; control thread.

#include <optional>
#include <string>
#include <string_view>

#include "base/params.hpp"
#include "base/time.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::robot {

/// The words of `then`.
enum class Then { Wait, Around, Return, Abort };
std::string_view to_string(Then then) noexcept;  // wait around return abort
/// Empty: no such word.
std::optional<Then> then_from(std::string_view word) noexcept;

struct BlockedParams {
  double clear_s = 1.0;
  double after_s = 10.0;
  std::string then = "wait";
  bool around_at_once = false;
  bool resume_blind = false;
  double resume_after_s = 5.0;
};

template <class V>
void fields(V& v, BlockedParams& p) {
  v("clear_s", p.clear_s, 0.2, 60.0,
    base::higher_is_stricter("what stands goes on when its way has been clear for so long"));
  v("after_s", p.after_s, 0.5, 3600.0, "what drives by itself and is stopped so long is blocked");
  v("then", p.then,
    "wait: until the way is clear; around: the same, and a way around is looked for; return: home, "
    "as RTL; abort: the mission ends");
  v("around_at_once", p.around_at_once,
    "then = \"around\": a way around is looked for at once, not after after_s");
  v("resume_blind", p.resume_blind,
    base::lower_is_stricter(
        "a mission that a blind sensor paused goes on by itself when the sensor sees again"));
  v("resume_after_s", p.resume_after_s, 0.0, 3600.0,
    base::higher_is_stricter("and has seen for so long"));
}

/// Invalid: a word that is none; the field is its name.
base::Result<void> check(const BlockedParams& params);

class Blocked {
 public:
  void set(const BlockedParams& params);

  /// Once a tick. @param stops the guard stops a drive by itself. @param solid something stands
  /// there: not merely that nobody has seen the way. @param at X_OB
  /// @return what is to be done now; told once
  std::optional<Then> step(bool stops, bool solid, const nav::sense::Pose2& at,
                           base::Time now) noexcept;
  void forget() noexcept;

  bool blocked() const noexcept { return stops_ && decided_; }
  /// When it will be; empty: it is, or nothing stops it.
  std::optional<base::Time> decides_at() const noexcept;
  /// For whoever plans the ways: a way around what stands there is wanted now. It may be looked for
  /// as long as this is so, and driven when there is one; while there is none the robot waits.
  bool wants_around() const noexcept;
  Then then() const noexcept { return then_; }
  const BlockedParams& params() const noexcept { return params_; }

 private:
  BlockedParams params_;
  Then then_ = Then::Wait;
  bool stops_ = false;
  bool solid_ = false;
  bool decided_ = false;
  std::optional<base::Time> since_;
  base::Time stopped_last_{};
  nav::sense::Pose2 stood_;
};

}  // namespace roverd::robot
