#include "nav/behave/guided.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {

std::string Guided::refusal(const GuidedGoal& goal) const {
  if (goal.kind == GuidedGoal::Kind::Turn && path_->vehicle.steered()) {
    return "this vehicle cannot turn on the spot";
  }
  return {};
}

void Guided::reset() noexcept {
  trip_.reset();
  state_ = State::Waiting;
  place_.reset();
  timed_out_ = false;
  speed_mps_ = rate_radps_ = 0.0;
}

void Guided::interrupt() noexcept {
  trip_.interrupt();
  if (state_ != State::Steered) return;
  speed_mps_ = rate_radps_ = 0.0;
  age_s_ = modes_->stream_timeout_s + 1.0;
}

void Guided::go(const GuidedGoal& goal, const Vehicle& v) {
  const bool steered_on = state_ == State::Steered && goal.kind == GuidedGoal::Kind::Steer;
  goal_ = goal;
  place_.reset();
  timed_out_ = false;
  age_s_ = looked_s_ = 0.0;
  if (goal.kind == GuidedGoal::Kind::Steer) {
    if (!steered_on) {
      trip_.reset();
      speed_mps_ = v.speed_mps;
      rate_radps_ = 0.0;
    }
    state_ = State::Steered;
    return;
  }
  if (goal.kind == GuidedGoal::Kind::Point) place_ = goal.at;
  if (goal.kind == GuidedGoal::Kind::Move) {
    place_ = EnuPoint{v.at.east_m + goal.forward_m * std::cos(v.yaw_rad),
                      v.at.north_m + goal.forward_m * std::sin(v.yaw_rad)};
  }
  state_ = State::Driving;
  lay(v, true);
}

void Guided::lay(const Vehicle& v, bool smoothly) {
  Trip::Order order;
  if (goal_.kind == GuidedGoal::Kind::Turn) {
    order.face_yaw_rad = goal_.yaw_rad;
    order.turn_rad = goal_.turn_rad;
    order.turn_radps = modes_->turn_radps;
    return trip_.begin(std::move(order), v, false);
  }
  Vertex end;
  end.at = *place_;
  end.reverse = goal_.reverse;
  end.speed_mps = std::min(goal_.speed_mps.value_or(path_->speed.default_mps),
                           goal_.reverse ? path_->speed.reverse_max_mps : path_->speed.max_mps);
  if (goal_.kind == GuidedGoal::Kind::Move) {
    end.reverse = goal_.forward_m < 0.0;
    end.speed_mps =
        goal_.speed_mps.value_or(end.reverse ? modes_->move_back_mps : modes_->move_mps);
  }
  const double far_m = base::distance_m(v.at, end.at);
  const bool cut_off = modes_->goal_cut_m > 0.0 && far_m > modes_->goal_cut_m;
  if (cut_off) {
    const double part = modes_->goal_cut_m / far_m;
    end.at = {v.at.east_m + part * (end.at.east_m - v.at.east_m),
              v.at.north_m + part * (end.at.north_m - v.at.north_m)};
  } else if (goal_.yaw_rad && path_->vehicle.steered()) {
    // It reaches a heading only by driving it: a straight before the pose, long enough to settle.
    const double run_m = std::max(2.0, 1.5 * min_radius_m(path_->vehicle));
    const double sign = end.reverse ? 1.0 : -1.0;
    Vertex before = end;
    before.at = {end.at.east_m + sign * run_m * std::cos(*goal_.yaw_rad),
                 end.at.north_m + sign * run_m * std::sin(*goal_.yaw_rad)};
    order.way.push_back(before);
  } else {
    order.face_yaw_rad = goal_.yaw_rad;
    order.turn_radps = path_->pivot.max_rate_radps;
  }
  order.way.push_back(end);
  trip_.begin(std::move(order), v, smoothly);
}

/// @return true: near enough to a goal that may be cut.
bool Guided::cut(const Vehicle& v, double dt_s) {
  if (modes_->goal_cut_m <= 0.0 || goal_.kind != GuidedGoal::Kind::Point) return false;
  const double far_m = base::distance_m(v.at, goal_.at);
  if (far_m <= modes_->goal_within_m && !goal_.yaw_rad) return true;
  looked_s_ += dt_s;
  const bool cut_off =
      base::distance_m(trip_.path().points.empty() ? goal_.at : trip_.path().points.back().at,
                       goal_.at) > 0.01;
  if (!cut_off || looked_s_ < modes_->goal_cut_s) return false;
  looked_s_ = 0.0;
  lay(v, true);
  return false;
}

TrackOutput Guided::step(const Vehicle& v, double limit_mps, double dt_s) {
  if (state_ == State::Steered) return steer(v, limit_mps, dt_s);
  if (state_ != State::Driving) return {};
  if (cut(v, dt_s)) {
    trip_.reset();
    state_ = State::Reached;
    return {};
  }
  const TrackOutput out = trip_.step(v, limit_mps, dt_s);
  if (trip_.state() == Trip::State::Failed) state_ = State::Failed;
  if (trip_.state() == Trip::State::There) {
    const bool all = modes_->goal_cut_m <= 0.0 || goal_.kind != GuidedGoal::Kind::Point ||
                     base::distance_m(v.at, goal_.at) <= modes_->goal_within_m;
    if (all) state_ = State::Reached;
    if (!all) lay(v, false);
  }
  return out;
}

/// Heading and speed, until they are too old.
TrackOutput Guided::steer(const Vehicle& v, double limit_mps, double dt_s) noexcept {
  age_s_ += dt_s;
  const SpeedParams& p = path_->speed;
  const bool old = age_s_ > modes_->stream_timeout_s;
  const double asked = goal_.speed_mps.value_or(p.default_mps);
  const double most = std::min(asked < 0.0 ? p.reverse_max_mps : p.max_mps, limit_mps);
  const double error = base::angle_diff_rad(v.yaw_rad, goal_.yaw_rad.value_or(v.yaw_rad));
  const bool turn_first =
      !path_->vehicle.steered() && std::abs(error) > base::rad_from_deg(path_->pivot.angle_deg);
  const double wanted = old || turn_first ? 0.0 : std::clamp(asked, -most, most);
  speed_mps_ = slew(speed_mps_, wanted, p.accel_mps2 * dt_s, p.hold_decel_mps2 * dt_s);
  const bool may_turn = !old || std::abs(speed_mps_) > 0.0;
  double rate = may_turn ? heading_rate_radps(error, modes_->heading_gain, *path_) : 0.0;
  const double side = p.lateral_mps2 / std::max(0.1, std::abs(speed_mps_));
  rate = std::clamp(rate, -side, side);
  if (turn_first && std::abs(speed_mps_) > 0.0) rate = 0.0;
  const double change = p.yaw_accel_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, rate, change, change);
  if (old && speed_mps_ == 0.0) {
    rate_radps_ = 0.0;
    timed_out_ = true;
    state_ = State::Waiting;
    return {{}, SpeedReason::Standing};
  }
  return {track_twist(v, speed_mps_, rate_radps_, *path_), old          ? SpeedReason::Stopping
                                                           : turn_first ? SpeedReason::Pivot
                                                                        : SpeedReason::Item};
}

std::string Guided::reason() const {
  if (state_ == State::Failed) return trip_.reason();
  if (timed_out_) return "no newer heading and speed came";
  return {};
}

std::optional<double> Guided::distance_left_m(EnuPoint here) const noexcept {
  if (!place_) return std::nullopt;
  if (modes_->goal_cut_m > 0.0) return base::distance_m(here, *place_);
  return trip_.distance_left_m();
}

}  // namespace roverd::nav
