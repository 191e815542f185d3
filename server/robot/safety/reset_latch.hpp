#pragma once
// An estimate that was set anew far from where it claimed to be, or again and again, is not to be
// driven by until a person has looked.
//
//   Open ──moved by over 1 m and over five of the sigmas that were claimed──▶ Latched
//        ──turned by over 20 deg and over five sigmas───────────────────────▶
//        ──moved by over 0.5 m or 10 deg twice within the time limit────────▶
//   Latched ──acknowledged, or the operator says where the robot stands──▶ Open
//
// While the robot is disarmed it may be carried, and its receiver is right: that does not latch,
// but whoever arms is told of it.
//
// Control thread; time is an argument.

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/angle.hpp"
#include "base/snapshot.hpp"
#include "robot/safety/estimate_watch.hpp"

namespace roverd::robot {

class ResetLatch {
 public:
  static constexpr double kFar_m = 1.0;
  static constexpr double kFar_deg = 20.0;
  static constexpr double kSigmas = 5.0;
  static constexpr double kAgain_m = 0.5;  ///< less is what slip that comes and goes does
  static constexpr double kAgain_deg = 10.0;

  /// Once a tick. @return true just when it latches.
  bool step(const base::EstimatorHealth& health, bool armed, double repeat_s, Time now) {
    if (health.resets == seen_) return false;
    seen_ = health.resets;
    const bool counts = health.last_reset && much(*health.last_reset);
    const bool again = counts && last_ && base::seconds(now - *last_) < repeat_s;
    if (counts) last_ = now;
    std::string why = health.last_reset ? far(*health.last_reset) : std::string();
    if (why.empty() && again) why = "the estimate was set anew twice within a short time";
    if (why.empty()) return false;
    if (!armed) {
      disarmed_why_ = std::move(why);
      return false;
    }
    const bool newly = why_.empty();
    why_ = std::move(why);
    return newly;
  }

  /// An operator moved the estimate himself: he knows.
  void moved_on_purpose(const base::EstimatorHealth& health) {
    seen_ = health.resets;
    acknowledge();
  }
  void acknowledge() {
    why_.clear();
    disarmed_why_.clear();
    last_.reset();
  }
  /// Whoever armed has read what happened before.
  void armed() { disarmed_why_.clear(); }

  /// Empty: not latched.
  const std::string& why() const noexcept { return why_; }
  /// The same of what happened while it was disarmed.
  const std::string& disarmed_why() const noexcept { return disarmed_why_; }

 private:
  static bool much(const base::EstimateReset& reset) {
    return std::hypot(reset.jump.east_m, reset.jump.north_m) > kAgain_m ||
           std::abs(base::deg_from_rad(reset.jump_rad)) > kAgain_deg;
  }
  static std::string far(const base::EstimateReset& reset) {
    const double moved_m = std::hypot(reset.jump.east_m, reset.jump.north_m);
    if (moved_m > kFar_m && moved_m > kSigmas * reset.claimed_m) {
      return "the position was set anew " + tenths_of(moved_m) +
             " m away, and had claimed to be known better";
    }
    const double turned_rad = std::abs(reset.jump_rad);
    if (base::deg_from_rad(turned_rad) > kFar_deg && turned_rad > kSigmas * reset.claimed_rad) {
      return "the heading was set anew by " + tenths_of(base::deg_from_rad(turned_rad)) +
             " deg, and had claimed to be known better";
    }
    return {};
  }

  std::uint64_t seen_ = 0;
  std::optional<Time> last_;
  std::string why_;
  std::string disarmed_why_;
};

}  // namespace roverd::robot
