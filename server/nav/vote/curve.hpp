#pragma once
// What tracks and gyro added up to lately, and what was believed meanwhile.

#include <cmath>
#include <optional>

#include "base/angle.hpp"
#include "nav/vote/ring.hpp"

namespace roverd::nav {

using base::Time;

/// Sums since the start, at one moment.
struct Moment {
  Time t;
  double path_m = 0.0;    ///< of the tracks, forth and back alike
  double ahead_m = 0.0;   ///< of the tracks, back is negative
  double turn_rad = 0.0;  ///< of the tracks, by their nominal width
  double gyro_rad = 0.0;  ///< of the gyro, without its bias
  double ref_rad = 0.0;   ///< what courses are compared along: the gyro's, else the tracks'
  double x_m = 0.0;       ///< the tracks' way laid out along `ref_rad`
  double y_m = 0.0;
  int gyro_run = 0;   ///< another one: the gyro fell silent between
  int track_run = 0;  ///< likewise the tracks
  int ref_run = 0;    ///< another one: the reference changed between
  // As believed then.
  double yaw_rad = 0.0;
  double yaw_sigma_rad = base::kPi;
  double scale = 1.0;
  double scale_sigma = 1.0;
  double pull_1pm = 0.0;
  double pull_sigma_1pm = 0.0;
};

/// The last 20 s.
class Curve {
 public:
  static constexpr double kStep_s = 0.04;

  void push(const Moment& m) noexcept {
    if (!ring_.empty() && base::seconds(m.t - ring_.newest().t) < kStep_s) return;
    ring_.push(m);
  }

  bool empty() const noexcept { return ring_.empty(); }
  const Moment& newest() const noexcept { return ring_.newest(); }

  /// Interpolated. Empty before what is kept; the newest one within 0.5 s after it.
  std::optional<Moment> at(Time t) const noexcept {
    const std::size_t i = ring_.not_after(t);
    if (i == ring_.size()) return std::nullopt;
    const Moment& a = ring_[i];
    if (i == 0) {
      if (base::seconds(t - a.t) > 0.5) return std::nullopt;
      return a;
    }
    const Moment& b = ring_[i - 1];
    const double part = base::seconds(t - a.t) / base::seconds(b.t - a.t);
    Moment m = a;
    m.t = t;
    m.path_m += part * (b.path_m - a.path_m);
    m.ahead_m += part * (b.ahead_m - a.ahead_m);
    m.turn_rad += part * (b.turn_rad - a.turn_rad);
    m.gyro_rad += part * (b.gyro_rad - a.gyro_rad);
    m.ref_rad += part * (b.ref_rad - a.ref_rad);
    m.x_m += part * (b.x_m - a.x_m);
    m.y_m += part * (b.y_m - a.y_m);
    return m;
  }

 private:
  Ring<Moment, 512> ring_;
};

}  // namespace roverd::nav
