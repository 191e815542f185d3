#pragma once
// How fast positions wander from what their receiver's own velocity adds up to: reflections under
// trees and beside walls lead them away by decimetres within seconds, and no receiver tells of it.
// With o = position − integrated velocity, over lags of one epoch and of about two seconds,
//
//   d_k = o₀ − 2·o_k + o_2k,   E|d_k|²/2 = 6 σ² + 2·q·k·dt  per axis,
//
// for white errors of σ and a random walk of q m²/s: what grows with the lag is the walk. A
// velocity with a constant error, an offset and slow drifts cancel. Wheels and tracks are not
// asked: they slip.
//
// Not thread-safe; no allocation; nothing here reads a clock.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::nav {

class WanderWatch {
 public:
  static constexpr double kWanders_m2ps = 0.025;  ///< a float solution's own is 0.004
  static constexpr double kCalm_m2ps = 0.01;      ///< believed again
  static constexpr double kOverNoise = 2.5;       ///< times the white part, over the long lag

  /// Of the antenna, over ground, east and north. @param t when it was so
  void velocity(base::EnuPoint mps, base::Time t) noexcept {
    const double dt_s = paced_ ? base::seconds(t - *paced_) : 0.0;
    if (paced_ && (dt_s <= 0.0 || dt_s > kGap_s)) begin();
    if (paced_ && dt_s > 0.0) {
      sum_.east_m += 0.5 * dt_s * (mps_.east_m + mps.east_m);
      sum_.north_m += 0.5 * dt_s * (mps_.north_m + mps.north_m);
    }
    mps_ = mps;
    paced_ = t;
  }

  /// Of the antenna. @param t when it was there; never goes back
  void position(base::EnuPoint at, base::Time t) noexcept {
    const double since_s = paced_ ? base::seconds(t - *paced_) : kGap_s;
    if (last_ && base::seconds(t - *last_) > kStale_s) forget();
    last_ = t;
    if (!since_) since_ = t;
    if (std::abs(since_s) >= kGap_s) return begin();
    const base::EnuPoint off{at.east_m - sum_.east_m - mps_.east_m * since_s,
                             at.north_m - sum_.north_m - mps_.north_m * since_s};
    if (size_ > 0) {
      const base::EnuPoint moved = off - back(0).off;
      const double dt_s = base::seconds(t - back(0).t);
      if (dt_s <= 0.0) return;
      if (dt_s > kGap_s || std::hypot(moved.east_m, moved.north_m) > kJump_m) {
        begin();
      } else {
        every_s_ += (size_ == 1 ? 1.0 : 0.1) * (dt_s - every_s_);
      }
    }
    head_ = (head_ + 1) % ring_.size();
    ring_[head_] = {t, off};
    size_ = std::min(size_ + 1, ring_.size());
    look();
  }

  /// It walks faster than an honest float solution does.
  bool wanders() const noexcept { return wanders_; }
  /// So much longer, at most, until they were watched for long enough to tell whether they wander:
  /// sooner where they are calm. 0: they were, or nothing came that would tell.
  double unknown_s() const noexcept {
    if (told_ || !since_) return 0.0;
    return std::max(0.0, kTells_s - base::seconds(*last_ - *since_));
  }
  /// Per axis; 0 until it is known.
  double rate_m2ps() const noexcept { return rate_m2ps_; }

  void forget() noexcept {
    begin();
    looks_ = 0;
    near_m2_ = far_m2_ = 0.0;
    rate_m2ps_ = 0.0;
    wanders_ = told_ = false;
    since_.reset();
    early_ = {};
  }

 private:
  static constexpr double kGap_s = 1.5;
  static constexpr double kStale_s = 15.0;  ///< what it did then says nothing of today
  static constexpr double kJump_m = 0.6;    ///< from one epoch to the next: another matter
  static constexpr double kLag_s = 2.0;
  static constexpr double kRemember_s = 5.0;
  static constexpr double kTells_s = 8.0;  ///< then the long lag has been looked at for 4 s
  static constexpr double kEarlyLag_s = 1.0;
  static constexpr double kEarlyFor_s = 2.8;  ///< looked at for so long
  static constexpr double kEarly_m2ps = 0.006;

  struct Spot {
    base::Time t;
    base::EnuPoint off;
  };
  /// The row of positions, not what is known of how they wander.
  void begin() noexcept { size_ = 0; }
  const Spot& back(std::size_t n) const noexcept {
    return ring_[(head_ + ring_.size() - n) % ring_.size()];
  }
  double bend_m2(std::size_t k) const noexcept {
    const base::EnuPoint a = back(0).off;
    const base::EnuPoint b = back(k).off;
    const base::EnuPoint c = back(2 * k).off;
    const double east_m = a.east_m - 2.0 * b.east_m + c.east_m;
    const double north_m = a.north_m - 2.0 * b.north_m + c.north_m;
    return 0.5 * (east_m * east_m + north_m * north_m);
  }

  /// In epochs.
  std::size_t lag(double s) const noexcept {
    const auto wanted = static_cast<std::size_t>(std::lround(s / std::max(every_s_, 0.02)));
    return std::clamp<std::size_t>(wanted, 2, (ring_.size() - 1) / 2);
  }

  /// Who stands for seconds before he starts need not wait for the long lag.
  void look_early() noexcept {
    const std::size_t k = lag(kEarlyLag_s);
    if (told_ || size_ < 2 * k + 1) return;
    ++early_.looks;
    early_.near_m2 += bend_m2(1);
    early_.far_m2 += bend_m2(k);
    const double for_s = early_.looks * every_s_;
    if (for_s < kEarlyFor_s) return;
    const double longer_s = static_cast<double>(k - 1) * every_s_;
    const double walk_m2 = (early_.far_m2 - early_.near_m2) / early_.looks;
    told_ = walk_m2 < kEarly_m2ps * 2.0 * longer_s;
  }

  void look() noexcept {
    look_early();
    const std::size_t k = lag(kLag_s);
    if (size_ < 2 * k + 1) return;
    ++looks_;
    const double share = std::max(1.0 / looks_, -std::expm1(-every_s_ / kRemember_s));
    near_m2_ += share * (bend_m2(1) - near_m2_);
    far_m2_ += share * (bend_m2(k) - far_m2_);
    const double longer_s = static_cast<double>(k - 1) * every_s_;
    rate_m2ps_ = std::max(0.0, far_m2_ - near_m2_) / (2.0 * longer_s);
    if (looks_ < static_cast<int>(k)) return;
    told_ = true;
    const double limit = wanders_ ? kCalm_m2ps : kWanders_m2ps;
    wanders_ = rate_m2ps_ > limit && (wanders_ || far_m2_ > kOverNoise * near_m2_);
  }

  std::array<Spot, 64> ring_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
  struct Early {
    int looks = 0;
    double near_m2 = 0.0;  ///< sums
    double far_m2 = 0.0;
  };

  std::optional<base::Time> since_;  ///< of the first position that is remembered
  std::optional<base::Time> last_;   ///< of the last position
  std::optional<base::Time> paced_;  ///< of the last velocity
  base::EnuPoint mps_;               ///< of it: m/s
  base::EnuPoint sum_;
  double every_s_ = 0.2;
  int looks_ = 0;
  double near_m2_ = 0.0;
  double far_m2_ = 0.0;
  double rate_m2ps_ = 0.0;
  bool wanders_ = false;
  bool told_ = false;  ///< whether they wander
  Early early_;
};

}  // namespace roverd::nav
