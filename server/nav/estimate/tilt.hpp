#pragma once
// How the robot leans, from gyro and accelerometer: the gyro for the moment, gravity in the long
// run. A device that works it out itself is believed instead.
//
//   up, seen from the body:  (sin pitch, sin roll · cos pitch, cos roll · cos pitch)
//   pitch: nose up positive, roll: right side down positive

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/measurements.hpp"

namespace roverd::nav {

class Tilt {
 public:
  static constexpr double kTau_s = 2.0;  ///< gravity's time constant: longer than a start or a stop

  /// @param speed_mps, turn_radps of the vehicle: a bend pushes sideways. @param sample finite.
  void put(const base::Inertial& sample, double speed_mps, double turn_radps) noexcept {
    const double dt_s = stamp_ ? base::seconds(sample.stamp - *stamp_) : 1e9;
    stamp_ = sample.stamp;
    const bool first = dt_s > 0.5;
    if (sample.rate_radps && !first) {
      roll_rad_ += sample.rate_radps->forward * dt_s;
      pitch_rad_ -= sample.rate_radps->left * dt_s;
    }
    if (!sample.accel_mps2) return;
    const double ahead = sample.accel_mps2->forward;
    const double left = sample.accel_mps2->left - speed_mps * turn_radps;
    const double up = sample.accel_mps2->up;
    const double force = std::sqrt(ahead * ahead + left * left + up * up);
    if (force < 8.0 || force > 11.6) return;  // a blow is not gravity
    const double part = first ? 1.0 : dt_s / (kTau_s + dt_s);
    roll_rad_ += part * (std::atan2(left, up) - roll_rad_);
    pitch_rad_ += part * (std::atan2(ahead, std::hypot(left, up)) - pitch_rad_);
    known_ = true;
  }

  /// Worked out by a device.
  void put(const base::Attitude& attitude) noexcept {
    told_ = attitude.stamp;
    told_roll_rad_ = attitude.roll_rad;
    told_pitch_rad_ = attitude.pitch_rad;
  }

  /// Empty: nothing tells, or not any more.
  std::optional<base::Attitude> at(base::Time now) const noexcept {
    if (told_ && base::seconds(now - *told_) < kFresh_s) {
      return base::Attitude{*told_, told_roll_rad_, told_pitch_rad_};
    }
    if (!known_ || base::seconds(now - *stamp_) >= kFresh_s) return std::nullopt;
    return base::Attitude{*stamp_, roll_rad_, pitch_rad_};
  }

  /// Turn rate about the vertical.
  double level_radps(const base::BodyVector& rate, base::Time now) const noexcept {
    const auto lean = at(now);
    if (!lean) return rate.up;
    const double roll = std::clamp(lean->roll_rad, -kMost_rad, kMost_rad);
    const double pitch = std::clamp(lean->pitch_rad, -kMost_rad, kMost_rad);
    return std::sin(pitch) * rate.forward + std::sin(roll) * std::cos(pitch) * rate.left +
           std::cos(roll) * std::cos(pitch) * rate.up;
  }

 private:
  static constexpr double kFresh_s = 0.5;
  static constexpr double kMost_rad = 0.8;  ///< beyond, it lies on its side

  std::optional<base::Time> stamp_;
  std::optional<base::Time> told_;
  double roll_rad_ = 0.0;
  double pitch_rad_ = 0.0;
  double told_roll_rad_ = 0.0;
  double told_pitch_rad_ = 0.0;
  bool known_ = false;
};

}  // namespace roverd::nav
