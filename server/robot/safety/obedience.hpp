#pragma once
// Does the base do what it is told? A base whose feedback arrives may still hear nothing of us.
//
//   Following ──told to move, does not, for the time limit──▶ Lost ──moves as told, or takes
//       ▲                                                      │     control when asked──▶
//       Following └──────────────────────────────────────────────────────┘
//
// Lost stays while the robot stands: only motion, or a change of mode that we asked for, shows that
// the commands arrive again. Judged is the larger demand alone: speed ahead, or the turn rate of a
// turn on the spot. What counts as told is the least of the last 0.4 s, so that a base may lag; and
// one that is still getting faster does it, as far as a load or a slope lets it.
// Control thread.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::robot {

class ObedienceWatch {
 public:
  static constexpr double kSpeed_mps = 0.1;     ///< slower commands prove nothing
  static constexpr double kTurn_radps = 0.15;   ///< likewise
  static constexpr double kShare = 0.5;         ///< less than this of what was told is not done
  static constexpr double kGains_mps = 0.04;    ///< faster by this within the limit: it obeys
  static constexpr double kGains_radps = 0.06;  ///< likewise
  static constexpr std::size_t kLagTicks = 20;  ///< 0.4 s

  /// Once a tick. @param told sent at the tick before. @param does empty: the base does not tell.
  void step(const base::BodyTwist& told, const std::optional<base::BodyTwist>& does, base::Time now,
            double limit_s) noexcept {
    told_[at_] = told;
    at_ = (at_ + 1) % kLagTicks;
    const bool turning = std::abs(told.linear_mps) < kSpeed_mps;
    const auto part = [turning](const base::BodyTwist& t) {
      return turning ? t.angular_radps : t.linear_mps;
    };
    const double wanted = least(part);
    const bool asks = std::abs(wanted) >= (turning ? kTurn_radps : kSpeed_mps);
    if (!asks || !does) {
      off_since_.reset();
      return;
    }
    const bool done = part(*does) * (wanted > 0.0 ? 1.0 : -1.0) >= kShare * std::abs(wanted);
    if (done) {
      off_since_.reset();
      lost_ = false;
      return;
    }
    const double now_does = part(*does) * (wanted > 0.0 ? 1.0 : -1.0);
    const double gains = turning ? kGains_radps : kGains_mps;
    if (!off_since_ || now_does >= slowest_ + gains) {
      off_since_ = now;
      slowest_ = now_does;
    }
    if (base::seconds(now - *off_since_) < limit_s) return;
    lost_ = true;
  }

  /// The base took control as it was asked to: commands arrive.
  void heard() noexcept { lost_ = false; }

  bool lost() const noexcept { return lost_; }
  /// Lost, and just now told to move.
  bool failing() const noexcept { return lost_ && off_since_.has_value(); }

 private:
  /// Of the last commands; 0 where they change their direction.
  template <class Part>
  double least(Part part) const noexcept {
    double low = part(told_[0]);
    double high = low;
    for (const base::BodyTwist& t : told_) {
      low = std::min(low, part(t));
      high = std::max(high, part(t));
    }
    return low > 0.0 ? low : high < 0.0 ? high : 0.0;
  }

  std::array<base::BodyTwist, kLagTicks> told_{};
  std::size_t at_ = 0;
  std::optional<base::Time> off_since_;
  double slowest_ = 0.0;  ///< what it did then, towards what was told
  bool lost_ = false;
};

}  // namespace roverd::robot
