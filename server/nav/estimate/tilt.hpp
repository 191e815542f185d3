#pragma once
// How the robot leans, from gyro and accelerometer: the gyro for the moment, gravity in the long
// run. A device that works it out itself is believed instead.
//
//   up, seen from the body:  (sin pitch, sin roll · cos pitch, cos roll · cos pitch)
//   pitch: nose up positive, roll: right side down positive
//
// Of the turn rates (ahead, left, up) about the body's axes (Titterton and Weston, Strapdown
// Inertial Navigation Technology, 2004, 3.6; signs as here):
//
//   heading' = (left · sin roll + up · cos roll) / cos pitch
//   roll' = ahead − heading' · sin pitch        pitch' = up · sin roll − left · cos roll

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/measurements.hpp"
#include "nav/estimate/gyro.hpp"

namespace roverd::nav {

class Tilt {
 public:
  static constexpr double kTau_s = 2.0;  ///< gravity's time constant: longer than a start or a stop

  /// @param speed_mps of the vehicle: a bend pushes sideways. @param up_radps its turn about its
  /// own up axis, without bias. @param sample finite; its rate about that axis is not looked at
  void put(const base::Inertial& sample, double speed_mps, double up_radps) noexcept {
    if (sample.rate_radps) {
      const double dt_s = turned_ ? base::seconds(sample.stamp - *turned_) : 1e9;
      turned_ = sample.stamp;
      if (known_ && dt_s > 0.0 && dt_s <= Gyro::kGap_s) {
        lean_on({sample.rate_radps->forward, sample.rate_radps->left, up_radps}, dt_s);
        known_ = sample.stamp;
      }
    }
    if (!sample.accel_mps2) return;
    const double ahead = sample.accel_mps2->forward;
    const double left = sample.accel_mps2->left - speed_mps * up_radps;
    const double up = sample.accel_mps2->up;
    const double force = std::sqrt(ahead * ahead + left * left + up * up);
    if (force < 8.0 || force > 11.6) return;  // a blow is not gravity
    const bool anew = !known_ || base::seconds(sample.stamp - *known_) > kFresh_s;
    const double dt_s = weighed_ ? base::seconds(sample.stamp - *weighed_) : Gyro::kGap_s;
    known_ = weighed_ = sample.stamp;
    const double after_s = std::clamp(dt_s, 0.0, Gyro::kGap_s);  // one sample is not many
    const double part = anew ? 1.0 : after_s / (kTau_s + after_s);
    roll_rad_ += part * (std::atan2(left, up) - roll_rad_);
    pitch_rad_ += part * (std::atan2(ahead, std::hypot(left, up)) - pitch_rad_);
  }

  /// Worked out by a device. One that is older than the last is none.
  void put(const base::Attitude& attitude) noexcept {
    if (told_ && attitude.stamp < *told_) return;
    told_ = attitude.stamp;
    told_roll_rad_ = attitude.roll_rad;
    told_pitch_rad_ = attitude.pitch_rad;
  }

  /// Empty: nothing tells, or not any more.
  std::optional<base::Attitude> at(base::Time now) const noexcept {
    if (told_ && base::seconds(now - *told_) < kFresh_s) {
      return base::Attitude{*told_, told_roll_rad_, told_pitch_rad_};
    }
    if (!known_ || base::seconds(now - *known_) >= kFresh_s) return std::nullopt;
    return base::Attitude{*known_, roll_rad_, pitch_rad_};
  }

  /// How fast the heading turns: that of the nose, laid onto the level.
  double heading_radps(const base::BodyVector& rate, base::Time now) const noexcept {
    const auto lean = at(now);
    return lean ? heading_radps(rate, lean->roll_rad, lean->pitch_rad) : rate.up;
  }

 private:
  static double heading_radps(const base::BodyVector& rate, double roll_rad,
                              double pitch_rad) noexcept {
    const double roll = std::clamp(roll_rad, -kMost_rad, kMost_rad);
    const double pitch = std::clamp(pitch_rad, -kMost_rad, kMost_rad);
    return (std::sin(roll) * rate.left + std::cos(roll) * rate.up) / std::cos(pitch);
  }

  /// Who turns on a slope leans otherwise by and by, though he turns about his own axis alone. By
  /// the rates of the step's middle.
  void lean_on(const base::BodyVector& rate, double dt_s) noexcept {
    const double roll = roll_rad_;
    const double pitch = pitch_rad_;
    for (const double part : {0.5, 1.0}) {
      const double rolls =
          rate.forward - std::sin(pitch_rad_) * heading_radps(rate, roll_rad_, pitch_rad_);
      const double nods = std::sin(roll_rad_) * rate.up - std::cos(roll_rad_) * rate.left;
      roll_rad_ = roll + part * dt_s * rolls;
      pitch_rad_ = pitch + part * dt_s * nods;
    }
  }

  static constexpr double kFresh_s = 0.5;
  static constexpr double kMost_rad = 0.8;  ///< beyond, it lies on its side

  std::optional<base::Time> turned_;   ///< the last sample with rates
  std::optional<base::Time> weighed_;  ///< the last one that showed gravity
  std::optional<base::Time> known_;    ///< the lean is of then
  std::optional<base::Time> told_;
  double roll_rad_ = 0.0;
  double pitch_rad_ = 0.0;
  double told_roll_rad_ = 0.0;
  double told_pitch_rad_ = 0.0;
};

}  // namespace roverd::nav
