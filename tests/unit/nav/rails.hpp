#pragma once
// A robot on rails for tests of the estimator.

#include <cmath>
#include <deque>
#include <optional>
#include <random>
#include <utility>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {

inline constexpr base::LatLon kOrigin{58.378, 26.729};

/// A robot on rails: says what it does to an estimator, with the delays that this one assumes.
class Drive {
 public:
  explicit Drive(const EstimateParams& params = {}) : estimator(params), params_(params) {}

  double speed_mps = 0.0;
  double rate_radps = 0.0;
  double east_m = 0.0;
  double north_m = 0.0;
  double yaw_rad = base::kPi / 2.0;
  double compass_bias_rad = 0.0;
  double crab = 0.0;        ///< for each metre so far to its left, reversing to its right
  double slide_east = 0.0;  ///< for each metre, whichever way it points
  double slide_north = 0.0;
  double pivot_m = 0.0;    ///< so far ahead of its origin it turns about
  double pitch_rad = 0.0;  ///< as gravity shows it: no other sense knows
  double antenna_forward_m = 0.0;
  bool antennas = false;
  double slip = 1.0;       ///< true over measured travel
  double yaw_scale = 0.8;  ///< true over measured turning
  base::FixType fix = base::FixType::RtkFixed;
  bool gnss = true;
  bool speeds = true;                 ///< the receiver tells velocities
  std::optional<double> told_late_s;  ///< it comes so late, with the time at which it was measured
  bool compass = true;
  bool tracks = true;
  bool gyro = false;
  double gyro_bias_radps = 0.0;
  double offset_east_m = 0.0;
  double noise_m = 0.0;
  Estimator estimator;

  Time now() const { return now_; }
  std::optional<base::Pose> pose() const { return estimator.pose(now_); }

  void run(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds * 50.0));
    for (int i = 0; i < ticks; ++i) tick();
  }

  double position_error_m() const {
    const auto p = pose();
    return base::distance_bearing(p->global, frame_.to_global({east_m, north_m})).distance_m;
  }
  double yaw_error_deg() const {
    return base::deg_from_rad(base::angle_diff_rad(yaw_rad, pose()->yaw_rad));
  }

  void tick() {
    now_ += std::chrono::milliseconds(20);
    const double dt = 0.02;
    const double middle = yaw_rad + 0.5 * rate_radps * dt;
    const auto [east_mps, north_mps] = over_ground(middle);
    east_m += east_mps * dt;
    north_m += north_mps * dt;
    yaw_rad = base::wrap_rad(yaw_rad + rate_radps * dt);
    if (gyro) {
      for (const int ms : {10, 0}) {
        base::Inertial inertial;
        inertial.stamp = now_ - std::chrono::milliseconds(ms);
        inertial.rate_radps = base::BodyVector{0.0, 0.0, rate_radps + gyro_bias_radps};
        inertial.accel_mps2 = base::BodyVector{9.81 * std::sin(pitch_rad), speed_mps * rate_radps,
                                               9.81 * std::cos(pitch_rad)};
        estimator.take(inertial, now_);
      }
    }
    if (tracks) {
      const double ahead = speed_mps / slip * dt;
      const double half = 0.5 * params_.track_width_m * rate_radps / yaw_scale * dt;
      estimator.take(base::WheelTravel{now_, ahead - half, ahead + half}, now_);
      estimator.take(base::BaseMotion{now_, {speed_mps / slip, rate_radps / yaw_scale}}, now_);
    }
    if (++count_ % 10 == 0) sense();
    deliver();
    estimator.advance(now_);
  }

 private:
  struct Seen {
    Time due, measured;
    double east_m, north_m, yaw_rad, ve, vn;
  };

  std::pair<double, double> over_ground(double yaw) const {
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    return {
        speed_mps * (c - crab * s) + std::abs(speed_mps) * slide_east + pivot_m * rate_radps * s,
        speed_mps * (s + crab * c) + std::abs(speed_mps) * slide_north - pivot_m * rate_radps * c};
  }
  void sense() {
    const auto [east_mps, north_mps] = over_ground(yaw_rad);
    const double arm_e = antenna_forward_m * std::cos(yaw_rad);
    const double arm_n = antenna_forward_m * std::sin(yaw_rad);
    const double late_s = told_late_s.value_or(params_.gnss_latency_s);
    seen_.push_back({now_ + base::from_seconds(late_s), now_,
                     east_m + offset_east_m + arm_e + noise_m * normal_(random_),
                     north_m + arm_n + noise_m * normal_(random_), yaw_rad,
                     east_mps - rate_radps * arm_n, north_mps + rate_radps * arm_e});
  }
  void deliver() {
    while (!seen_.empty() && seen_.front().due <= now_) {
      const Seen s = seen_.front();
      seen_.pop_front();
      if (compass) {
        const double shown = base::wrap_rad(s.yaw_rad + compass_bias_rad);
        estimator.take(base::Heading{now_, shown, base::HeadingSource::Compass}, now_);
      }
      if (antennas) {
        estimator.take(base::Heading{now_, s.yaw_rad, base::HeadingSource::DualAntenna}, now_);
      }
      if (!gnss) continue;
      base::GnssFix f;
      f.stamp = told_late_s ? s.measured : now_;
      if (told_late_s) f.latency_s = 0.0;
      f.fix = fix;
      f.position = frame_.to_global({s.east_m, s.north_m});
      estimator.take(f, now_);
      if (!speeds) continue;
      estimator.take(base::GnssVelocity{f.stamp, s.ve, s.vn, {}, f.latency_s}, now_);
    }
  }

  EstimateParams params_;
  base::LocalFrame frame_{7, kOrigin};
  Time now_{};
  int count_ = 0;
  std::deque<Seen> seen_;
  std::mt19937_64 random_{4};
  std::normal_distribution<double> normal_;
};

}  // namespace roverd::nav
