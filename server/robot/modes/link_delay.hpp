#pragma once
// How late is whoever drives by hand? And how fast may the robot be driven so?
//
//   age of a stick: now − the robot's time at which its sender saw the robot (round trip and all)
//   bound = smoothed age + 4 · smoothed deviation      (RFC 6298, section 2: SRTT + 4 RTTVAR)
//   share 1 ──────────╲
//                      ╲
//   share 0             ╲──────   over the bound, or over the age of the newest, the larger
//            delay_free_s  delay_stop_s
//
// Who sends sticks without the time seen is as late as its bytes took to arrive: that is all there
// is to know. Control thread.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/time.hpp"
#include "robot/config.hpp"

namespace roverd::robot {

class LinkDelay {
 public:
  /// Somebody else drives, or anew.
  void reset() noexcept { mean_s_.reset(); }

  void take(base::Time said, base::Time now) noexcept {
    const double age_s = std::max(0.0, base::seconds(now - said));
    if (mean_s_) {
      deviation_s_ += (std::abs(*mean_s_ - age_s) - deviation_s_) / 4.0;
      *mean_s_ += (age_s - *mean_s_) / 8.0;
    } else {
      mean_s_ = age_s;
      deviation_s_ = age_s / 2.0;
    }
    said_ = said;
  }

  /// What the age stays below. Empty: nobody drives.
  std::optional<double> bound_s(base::Time now) const noexcept {
    if (!mean_s_) return std::nullopt;
    return std::max(*mean_s_ + 4.0 * deviation_s_, base::seconds(now - said_));
  }

  /// Of the full speed, 0..1.
  double share(const ManualParams& p, base::Time now) const noexcept {
    const double late_s = bound_s(now).value_or(0.0);
    if (late_s <= p.delay_free_s) return 1.0;
    if (late_s >= p.delay_stop_s) return 0.0;
    return (p.delay_stop_s - late_s) / (p.delay_stop_s - p.delay_free_s);
  }

 private:
  std::optional<double> mean_s_;
  double deviation_s_ = 0.0;
  base::Time said_{};
};

}  // namespace roverd::robot
