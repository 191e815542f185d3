#pragma once
// A receiver whose fixed solution is wrong and runs away at an even speed, and claims its 1.5 cm
// all the while: how far the robot is led from its way by it, and how long until it stops. And
// honest receivers on grounds that make a robot slide as if they lied.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rig.hpp"

namespace roverd::loop {

/// The grounds by number: firm, 5 and 10 % of crab, a slope of 10 deg, slip by place, crab by
/// place.
inline constexpr std::uint64_t kGrounds = 6;
inline const char* ground_name(std::uint64_t ground) {
  constexpr std::array kNames{"firm",         "crab_5",       "crab_10",
                              "slope_10_deg", "slip_patches", "crab_patches"};
  return kNames[ground % kGrounds];
}

inline void lay_ground(RigOptions& o, std::uint64_t ground) {
  switch (ground % kGrounds) {
    case 1:
      o.plant.drive.crab = 0.05;
      break;
    case 2:
      o.plant.drive.crab = -0.10;
      break;
    case 3:
      o.plant.ground.slope_deg = 10.0;
      o.plant.ground.uphill_deg = 50.0;
      break;
    case 4:
      o.plant.ground.slip_patches = 0.4;
      break;
    case 5:
      o.plant.ground.crab_patches = 0.1;
      break;
    default:
      break;
  }
}

struct DriftLie {
  double mps = 0.0;  ///< 0: an honest receiver
  double towards_deg = 0.0;
  double from_m = 12.0;       ///< of the way, where it begins
  bool velocity_too = false;  ///< it tells of a velocity that goes with it

  /// So long it stays within what an honest fix errs by: three times the claimed 1.5 cm.
  double hidden_s() const { return mps > 0.0 ? 0.045 / mps : 0.0; }
};

/// Speeds evenly by their logarithm, directions and begins each by a sequence of its own.
inline DriftLie drift_lie(std::uint64_t i, double least_mps, double most_mps) {
  const auto part = [i](double step) { return std::fmod(step * static_cast<double>(i), 1.0); };
  return {least_mps * std::pow(most_mps / least_mps, part(0.6180339887)), 360.0 * part(0.56984029),
          12.0 + 10.0 * part(0.7548776662)};
}

struct DriftSeen {
  double astray_m = 0.0;   ///< farthest from its way after the lie began
  double before_m = 0.0;   ///< farthest from its way before it
  double found_s = -1.0;   ///< since the lie began: it is named, or the two that differ; -1: never
  double stands_s = -1.0;  ///< likewise, until it stands
  double dishonest_m = 0.0;  ///< by which the error passes three sigmas and 0.15 m
  bool arrived = false;
  bool held = false;
  std::string why;  ///< it held
};

/// One drive of a serpentine of 45 m at 1 m/s.
class DriftDrive {
 public:
  /// @param lag_s of the receiver's velocity
  DriftDrive(std::uint64_t seed, std::uint64_t ground, const DriftLie& lie, double lag_s = 0.0)
      : lie_(lie) {
    RigOptions o;
    o.plant.gnss.velocity_lag_s = lag_s;
    o.seed = seed;
    o.plant.gnss.noise_scale = 1.44;
    lay_ground(o, ground);
    rig_ = std::make_unique<Rig>(o);
    for (int i = 1; i <= 60; ++i) {
      points_.push_back({1.6 * std::sin(base::kPi * i / 15.0), 0.75 * i});
    }
    rig_->arm_and_start(rig_->plan_of(points_, 1.0));
    points_.insert(points_.begin(), Metres{0, 0});
  }

  DriftSeen run() {
    DriftSeen seen;
    if (!rig_->run_until([&] { return rig_->truth().driven_m > lie_.from_m; }, 120.0)) return seen;
    seen.before_m = rig_->farthest_from_path_m(points_);
    const double began_s = rig_->now_s();
    rig_->fault([this](sim::Faults& f) {
      f.gnss_drift_east_mps = lie_.mps * std::cos(base::rad_from_deg(lie_.towards_deg));
      f.gnss_drift_north_mps = lie_.mps * std::sin(base::rad_from_deg(lie_.towards_deg));
      if (!lie_.velocity_too) return;
      f.gnss_velocity_east_mps = f.gnss_drift_east_mps;
      f.gnss_velocity_north_mps = f.gnss_drift_north_mps;
    });
    for (int i = 0; i < 40 * 50; ++i) {
      rig_->tick();
      const auto s = rig_->state();
      const double lasted_s = rig_->now_s() - began_s;
      seen.astray_m = std::max(seen.astray_m, astray_m());
      if (rig_->execution() == ExecutionState::Finished) {
        seen.arrived = true;
        break;
      }
      const auto& votes = s->estimator.votes;
      const bool found = votes.undecided || votes[base::Sense::Position].left_out;
      const double claim_m = 3.0 * s->pose->horizontal_sigma_m + 0.15;
      seen.dishonest_m = std::max(seen.dishonest_m, rig_->position_error_m() - claim_m);
      if (!seen.held && rig_->execution() == ExecutionState::Paused) {
        seen.held = true;
        seen.why = s->mission.reason;
      }
      if (seen.found_s < 0.0 && found) seen.found_s = lasted_s;
      if (seen.stands_s < 0.0 && seen.found_s >= 0.0 && rig_->stands()) seen.stands_s = lasted_s;
      if (seen.stands_s >= 0.0 && lasted_s > seen.stands_s + 1.0) break;
    }
    accusations = rig_->state()->estimator.votes.accusations;
    return seen;
  }

  std::uint64_t accusations = 0;

 private:
  double astray_m() const {
    const auto p = rig_->truth().local;
    double best = 1e9;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      best = std::min(best, RigBase::to_segment(p, points_[i], points_[i + 1]));
    }
    return best;
  }

  DriftLie lie_;
  std::vector<Metres> points_;
  std::unique_ptr<Rig> rig_;
};

}  // namespace roverd::loop
