#pragma once
// Driving by hand over the network: a dead-man's handle with a time limit.
//
//   Free ──drive, dead-man held──▶ Held ──released──▶ Free
//                                   │ nothing for 0.5 s
//                                   ▼
//                                  Stale ──released (or speed zero)──▶ Free
//
// After a gap in the stream the handle must be let go once: a loss never goes on by itself.
// Control thread.

#include <algorithm>
#include <optional>
#include <utility>

#include "base/geo.hpp"
#include "base/setting.hpp"
#include "base/time.hpp"
#include "robot/config.hpp"

namespace roverd::robot {

class Manual {
 public:
  enum class Phase { Free, Held, Stale };

  explicit Manual(base::Setting<ManualParams> params) : params_(std::move(params)) {}

  void drive(const base::BodyTwist& twist, bool deadman, base::Time now) noexcept {
    last_ = now;
    const bool zero = twist.linear_mps == 0.0 && twist.angular_radps == 0.0;
    if (!deadman) {
      release();
    } else if (phase_ != Phase::Stale || zero) {
      phase_ = Phase::Held;
      wanted_ = twist;
    }
  }

  /// Nobody holds it: after a change of mode, a stop, or let go.
  void release() noexcept {
    phase_ = Phase::Free;
    wanted_ = now_ = {};
  }

  /// Once a tick. Speeds up within limits; slows down and stops at once.
  base::BodyTwist step(base::Time now, double dt_s) noexcept {
    if (phase_ == Phase::Held && base::seconds(now - last_) > params_->timeout_s) {
      phase_ = Phase::Stale;
      wanted_ = {};
    }
    const ManualParams& p = *params_;
    now_.linear_mps = grow(now_.linear_mps, std::clamp(wanted_.linear_mps, -p.max_mps, p.max_mps),
                           p.accel_mps2 * dt_s);
    now_.angular_radps =
        grow(now_.angular_radps,
             std::clamp(wanted_.angular_radps, -p.max_yaw_rate_radps, p.max_yaw_rate_radps),
             p.yaw_accel_radps2 * dt_s);
    return now_;
  }

  Phase phase() const noexcept { return phase_; }

 private:
  static double grow(double from, double to, double step) noexcept {
    if (from * to < 0.0) from = 0.0;
    if (to > from) return to > 0.0 ? std::min(to, from + step) : to;
    return to < 0.0 ? std::max(to, from - step) : to;
  }

  base::Setting<ManualParams> params_;
  Phase phase_ = Phase::Free;
  base::Time last_{};
  base::BodyTwist wanted_{};
  base::BodyTwist now_{};
};

}  // namespace roverd::robot
