#pragma once
// Driving by hand over the network: a dead-man's handle with a time limit. A handle that is held
// already never begins to act by itself: whoever drives must have been seen with sticks neutral and
// dead-man off since the last thing that began.
//
//   Locked ──let go, by one source or more──▶ Ready ──dead-man held, by one of them──▶ Held
//     ▲ ▲                                       ▲                                       │ │
//     │ │                                       └──────── the same one lets go ─────────┘ │
//     │ └── nothing for 0.5 s; it left; let go with a stick out of the middle ────────────┘
//     └── whatever begins: armed, another mode, an emergency stop, the radio gave back …  (any
//     phase)
//
// "Let go" counts for the source that said it alone, and only if it was said after what began. When
// one has driven and lets go, all others must have let go since. Control thread.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/geo.hpp"
#include "base/setting.hpp"
#include "base/time.hpp"
#include "robot/config.hpp"
#include "robot/modes/link_delay.hpp"

namespace roverd::robot {

/// One message of a handle.
struct Handle {
  base::BodyTwist twist;
  bool deadman = false;
  std::uint64_t source = 0;     ///< who holds it
  base::Time said;              ///< the sender saw the robot's state of then
  bool gone = false;            ///< the source does not speak any more; with the dead-man off
  bool override_guard = false;  ///< on, slowly, where the guard would stop
};

class Manual {
 public:
  enum class Phase { Locked, Ready, Held };
  /// Nearer to the middle is neutral.
  static constexpr double kNeutral_mps = 0.02;
  static constexpr double kNeutral_radps = 0.02;
  /// So many may be ready at once; one more makes the one that let go longest ago let go again.
  static constexpr std::size_t kSources = 16;

  explicit Manual(base::Setting<ManualParams> params) : params_(std::move(params)) {}

  static bool neutral(const base::BodyTwist& twist) noexcept {
    return std::abs(twist.linear_mps) <= kNeutral_mps &&
           std::abs(twist.angular_radps) <= kNeutral_radps;
  }

  /// @return false: not obeyed, see why().
  bool drive(const Handle& h, base::Time now) noexcept {
    if (!h.deadman) {
      let_go(h, now);
      return true;
    }
    if (holder_ ? *holder_ != h.source : !released_by(h.source)) {
      in_vain_ = now;
      return false;
    }
    if (!holder_) delay_.reset();
    holder_ = h.source;
    last_ = now;
    wanted_ = h.twist;
    overrides_ = h.override_guard;
    delay_.take(h.said, now);
    return true;
  }

  /// Something begins, or ends: nobody holds it, and all must let go. @param cause a static text,
  /// "the robot was armed"
  void lock(const char* cause, base::Time now) noexcept {
    holder_.reset();
    released_.clear();
    overrides_ = false;
    wanted_ = now_ = {};
    cause_ = cause;
    began_ = now;
  }

  /// Once a tick. Speeds up within limits; slows down and stops at once.
  base::BodyTwist step(base::Time now, double dt_s) noexcept {
    if (holder_ && base::seconds(now - last_) > params_->timeout_s) lock(kSilent, now);
    const ManualParams& p = *params_;
    const double share = share_of_speed(now);
    const double mps = share * p.max_mps;
    const double radps = share * p.max_yaw_rate_radps;
    now_.linear_mps =
        grow(now_.linear_mps, std::clamp(wanted_.linear_mps, -mps, mps), p.accel_mps2 * dt_s);
    now_.angular_radps = grow(now_.angular_radps, std::clamp(wanted_.angular_radps, -radps, radps),
                              p.yaw_accel_radps2 * dt_s);
    return now_;
  }

  /// Of the full speed, as the link of whoever drives allows it, 0..1.
  double share_of_speed(base::Time now) const noexcept {
    return holder_ ? delay_.share(*params_, now) : 1.0;
  }
  /// Of whoever drives: its commands are not later. Empty: nobody does.
  std::optional<double> delay_s(base::Time now) const noexcept {
    return holder_ ? delay_.bound_s(now) : std::nullopt;
  }

  Phase phase() const noexcept {
    return holder_ ? Phase::Held : released_.empty() ? Phase::Locked : Phase::Ready;
  }
  /// Whoever drives holds the guard off as well, as of his last word.
  bool overrides_guard() const noexcept { return holder_ && overrides_; }
  bool stale() const noexcept { return phase() == Phase::Locked && cause_ == kSilent; }
  /// Somebody pushes it just now and is not obeyed.
  bool in_vain(base::Time now) const noexcept {
    return in_vain_ && !holder_ && base::seconds(now - *in_vain_) <= params_->timeout_s;
  }
  /// What helps, and why.
  std::string why() const {
    if (holder_) return "another client is driving";
    return std::string("release the stick first, and the dead-man's switch: ") + cause_;
  }
  /// Who has let go; of these one may drive.
  const std::vector<std::uint64_t>& released() const noexcept { return released_; }

 private:
  static constexpr const char* kSilent = "the commands by hand stopped coming";

  bool released_by(std::uint64_t source) const noexcept {
    return std::find(released_.begin(), released_.end(), source) != released_.end();
  }

  void let_go(const Handle& h, base::Time now) noexcept {
    const bool held = holder_ && h.source == *holder_;
    if (held) lock(h.gone ? "whoever drove has left" : "another client drove", now);
    std::erase(released_, h.source);
    if (h.gone) return;
    if (!neutral(h.twist)) {
      if (held) cause_ = "the sticks were not in the middle";
      return;
    }
    if (!held && h.said < began_) return;  // what it says is of the time before
    if (released_.size() >= kSources) released_.erase(released_.begin());
    released_.push_back(h.source);
  }

  static double grow(double from, double to, double step) noexcept {
    if (from * to < 0.0) from = 0.0;
    if (to > from) return to > 0.0 ? std::min(to, from + step) : to;
    return to < 0.0 ? std::max(to, from - step) : to;
  }

  base::Setting<ManualParams> params_;
  std::optional<std::uint64_t> holder_;
  std::vector<std::uint64_t> released_;  ///< since began_, the newest last
  base::Time began_{};
  const char* cause_ = "the program was started";
  base::Time last_{};
  std::optional<base::Time> in_vain_;
  LinkDelay delay_;  ///< of the holder
  bool overrides_ = false;
  base::BodyTwist wanted_{};
  base::BodyTwist now_{};
};

}  // namespace roverd::robot
