#pragma once
// LOITER: stays at a place; pushed or slid away from it, drives back.
//
//   Idle ──begin──▶ Driving ──there──▶ Staying ──farther than the radius──▶ Driving
//                      └──missed, stuck──▶ Failed (HOLD follows)
//
//   Exit: any other mode; a condition that holds; the fence. It has no end of its own.
// Back it drives tail first where that is shorter than to turn round. Control thread.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/angle.hpp"
#include "base/setting.hpp"
#include "nav/behave/trip.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {

struct StayGoal {
  EnuPoint at;
  double within_m = 1.0;              ///< and not less than the position is known
  std::optional<double> speed_mps{};  ///< empty: the default
};

class Stay {
 public:
  enum class State { Idle, Driving, Staying, Failed };

  Stay(base::Setting<PathParams> path, base::Setting<BehaveParams> behave)
      : path_(path), behave_(behave), trip_(std::move(path), std::move(behave)) {}

  void begin(const StayGoal& goal, const Vehicle& vehicle) {
    goal_ = goal;
    state_ = State::Staying;
    if (away(vehicle)) drive(vehicle);
  }
  void reset() noexcept {
    trip_.reset();
    state_ = State::Idle;
  }
  void interrupt() noexcept { trip_.interrupt(); }

  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s) {
    if (state_ == State::Staying && away(vehicle)) drive(vehicle);
    if (state_ != State::Driving) return {};
    const TrackOutput out = trip_.step(vehicle, limit_mps, dt_s);
    if (trip_.state() == Trip::State::There) state_ = State::Staying;
    if (trip_.state() == Trip::State::Failed) state_ = State::Failed;
    return out;
  }

  State state() const noexcept { return state_; }
  const StayGoal& goal() const noexcept { return goal_; }
  const std::string& reason() const noexcept { return trip_.reason(); }
  double distance_m(EnuPoint here) const noexcept { return base::distance_m(here, goal_.at); }

 private:
  bool away(const Vehicle& v) const noexcept {
    return distance_m(v.at) > std::max(goal_.within_m, behave_->arrive_sigmas * v.sigma_m);
  }
  void drive(const Vehicle& v) {
    Vertex end;
    end.at = goal_.at;
    const double bearing_rad = base::angle_diff_rad(v.yaw_rad, direction_rad(v.at, goal_.at));
    const bool near = distance_m(v.at) < kBack_m;
    end.reverse = near && std::abs(bearing_rad) > 0.5 * base::kPi;
    const SpeedParams& p = path_->speed;
    end.speed_mps = std::min(goal_.speed_mps.value_or(p.default_mps),
                             end.reverse ? p.reverse_max_mps : p.max_mps);
    Trip::Order order;
    order.way.push_back(end);
    order.within_m = std::max(goal_.within_m, behave_->arrive_sigmas * v.sigma_m);
    trip_.begin(std::move(order), v, false);
    state_ = State::Driving;
  }

  static constexpr double kBack_m = 10.0;  // farther it turns round first

  base::Setting<PathParams> path_;
  base::Setting<BehaveParams> behave_;
  Trip trip_;
  StayGoal goal_;
  State state_ = State::Idle;
};

}  // namespace roverd::nav
