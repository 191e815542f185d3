#pragma once
// Do positions scatter as little as their receiver claims? From one epoch to the next what is
// believed follows odometry and gyro, good to millimetres, so that what is left of three
// neighbouring differences to it,
//
//   d = e₀ − 2e₁ + e₂,   var d = 6 σ² for white errors of σ,
//
// is the receiver's own noise: a slow error, a slide and a wrong scale cancel. Reflections under
// trees make it several times what is claimed. Where the belief follows the positions themselves
// by a gain of a half, honest noise looks 1.3 times as large, near one 1.8 times: kNoisy has room
// for that, and finds noise of twice the claim then.
//
// Not thread-safe; no allocation; nothing here reads a clock.

#include <algorithm>
#include <array>
#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::nav {

class NoiseWatch {
 public:
  static constexpr double kNoisy = 2.5;  ///< times the claim: not believed any more
  static constexpr double kQuiet = 1.7;  ///< times the claim: believed again
  static constexpr double kShare = 0.2;  ///< of a new difference; about five count
  static constexpr base::Duration kApart = std::chrono::milliseconds(1500);

  /// Once a position. @param off it, less where the antenna was believed to be then, ENU, m
  /// @param sigma_m claimed, per axis, > 0 @param stamp never goes back
  void take(base::EnuPoint off, double sigma_m, base::Time stamp) noexcept {
    if (last_ && stamp - *last_ > kApart) seen_ = 0;
    last_ = stamp;
    if (seen_ >= 2) {
      const double east_m = off.east_m - 2.0 * before_[1].east_m + before_[0].east_m;
      const double north_m = off.north_m - 2.0 * before_[1].north_m + before_[0].north_m;
      const double ratio2 = (east_m * east_m + north_m * north_m) / (2.0 * 6.0 * sigma_m * sigma_m);
      // One wild epoch is an outlier, which others look after.
      mean_ratio2_ += kShare * (std::min(ratio2, kMost) - mean_ratio2_);
      const double limit = noisy_ ? kQuiet : kNoisy;
      noisy_ = mean_ratio2_ > limit * limit;
    }
    before_ = {before_[1], off};
    seen_ = std::min(seen_ + 1, 2);
  }
  bool noisy() const noexcept { return noisy_; }

 private:
  static constexpr double kMost =
      10.0;  ///< so that one epoch, which is in three of them, convicts nobody

  std::array<base::EnuPoint, 2> before_{};
  std::optional<base::Time> last_;
  double mean_ratio2_ = 1.0;
  int seen_ = 0;
  bool noisy_ = false;
};

}  // namespace roverd::nav
