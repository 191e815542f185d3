#pragma once
// RTL and SMART_RTL: to home, or to the rally point that can be reached.
//
//   Enter: armed, position known, a home. RTL: the straight way lies inside the fence, else the
//          nearest rally point whose way does. SMART_RTL: breadcrumbs without a long gap.
//
//   Idle ──begin──▶ Driving ──stands at home──▶ Home (HOLD follows)
//                      └──missed, stuck, lost──▶ Failed (HOLD follows)
//
//   Exit: any other mode; a condition that holds; the fence. Begun again, SMART_RTL goes on from
//         the crumbs that are left: those behind it were forgotten on the way.
// Control thread.

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/angle.hpp"
#include "base/setting.hpp"
#include "nav/behave/trip.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {

class Rtl {
 public:
  enum class State { Idle, Driving, Home, Failed };

  Rtl(base::Setting<PathParams> path, base::Setting<BehaveParams> behave)
      : path_(std::move(path)), trip_(path_, std::move(behave)) {}

  /// @param way to be driven in order; the last one is home. Corners are rounded.
  /// @param retrace it was driven before: a steered vehicle, which cannot turn round on it, drives
  /// it backwards where it came forwards, and forwards where it came backwards
  void begin(std::span<const EnuPoint> way, const Vehicle& vehicle, bool retrace) {
    Trip::Order order;
    order.way.reserve(way.size());
    const double speed_mps = std::min(path_->speed.default_mps, path_->speed.max_mps);
    const bool may_reverse = retrace && path_->vehicle.steered();
    EnuPoint from = vehicle.at;
    double facing_rad = vehicle.yaw_rad;
    for (const EnuPoint& p : way) {
      // Too near to say where the way leads.
      const bool near = base::distance_m(from, p) < kNoDirection_m && &p != &way.back();
      if (may_reverse && near) continue;
      const double yaw_rad = direction_rad(from, p);
      const bool behind =
          std::abs(base::angle_diff_rad(facing_rad, yaw_rad)) > 0.5 * base::kPi && may_reverse;
      facing_rad = behind ? base::wrap_rad(yaw_rad + base::kPi) : yaw_rad;
      from = p;
      order.way.push_back(
          {p, speed_mps, behind, false, mission::Turn::Auto, path_->track.corner_deviation_m});
    }
    trip_.begin(std::move(order), vehicle, false);
    state_ = State::Driving;
  }
  void reset() noexcept {
    trip_.reset();
    state_ = State::Idle;
  }
  void interrupt() noexcept { trip_.interrupt(); }

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s) {
    if (state_ != State::Driving) return {};
    const TrackOutput out = trip_.step(vehicle, limit_mps, dt_s);
    if (trip_.state() == Trip::State::There) state_ = State::Home;
    if (trip_.state() == Trip::State::Failed) state_ = State::Failed;
    return out;
  }

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return trip_.reason(); }
  const Trip& trip() const noexcept { return trip_; }

 private:
  static constexpr double kNoDirection_m = 0.4;

  base::Setting<PathParams> path_;
  Trip trip_;
  State state_ = State::Idle;
};

}  // namespace roverd::nav
