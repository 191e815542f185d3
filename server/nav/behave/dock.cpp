#include "nav/behave/dock.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kOnLine_m = 0.005;
constexpr double kJoin = 8.0;  // metres along the line for each beside it

}  // namespace

void Dock::reset() noexcept {
  trip_.reset();
  state_ = State::Idle;
  reason_.clear();
}

/// A steered vehicle needs room to come onto the line.
double Dock::straight_m() const noexcept {
  return path_->vehicle.steered()
             ? std::max(modes_->dock_approach_m, 3.0 * min_radius_m(path_->vehicle))
             : modes_->dock_approach_m;
}

EnuPoint Dock::gate() const noexcept {
  const double sign = goal_.reverse ? 1.0 : -1.0;
  return {goal_.at.east_m + sign * straight_m() * std::cos(goal_.yaw_rad),
          goal_.at.north_m + sign * straight_m() * std::sin(goal_.yaw_rad)};
}

void Dock::begin(const DockGoal& goal, const Vehicle& v) {
  goal_ = goal;
  tries_ = 0;
  reason_.clear();
  to_gate(v);
}

void Dock::to_gate(const Vehicle& v) {
  Trip::Order order;
  Vertex at_gate;
  at_gate.at = gate();
  at_gate.speed_mps = std::min(path_->speed.default_mps, path_->speed.max_mps);
  if (path_->vehicle.steered()) {
    // It cannot turn at the gate: it comes through a point before it, in line with the pose.
    const double sign = goal_.reverse ? -1.0 : 1.0;
    const double more_m = 2.0 * min_radius_m(path_->vehicle);
    Vertex before = at_gate;
    before.at = {at_gate.at.east_m - sign * more_m * std::cos(goal_.yaw_rad),
                 at_gate.at.north_m - sign * more_m * std::sin(goal_.yaw_rad)};
    before.reverse = at_gate.reverse = goal_.reverse;
    order.way.push_back(before);
  } else {
    order.face_yaw_rad = goal_.yaw_rad;
    order.turn_radps = path_->pivot.max_rate_radps;
  }
  order.way.push_back(at_gate);
  order.within_m = path_->vehicle.steered() ? 1.0 : 0.3;
  state_ = State::ToGate;
  trip_.begin(std::move(order), v, false);
}

/// A steered vehicle keeps the heading that it arrives with: from beside the line it comes onto it
/// first, well before the pose.
std::optional<EnuPoint> Dock::join(const Vehicle& v) const noexcept {
  if (!path_->vehicle.steered()) return std::nullopt;
  const double sign = goal_.reverse ? -1.0 : 1.0;
  const EnuPoint along{sign * std::cos(goal_.yaw_rad), sign * std::sin(goal_.yaw_rad)};
  const EnuPoint to = goal_.at - v.at;
  const double rest_m = to.east_m * along.east_m + to.north_m * along.north_m;
  const double off_m = std::abs(to.east_m * along.north_m - to.north_m * along.east_m);
  const double back_m = rest_m - std::clamp(kJoin * off_m, 0.5, 0.6 * std::max(rest_m, 1.0));
  if (off_m < kOnLine_m || back_m < 0.5) return std::nullopt;
  return goal_.at - EnuPoint{back_m * along.east_m, back_m * along.north_m};
}

/// Along the line through the pose, from where it stands beside it.
void Dock::straight(const Vehicle& v) {
  Trip::Order order;
  Vertex end;
  end.at = goal_.at;
  end.reverse = goal_.reverse;
  end.speed_mps = modes_->dock_mps;
  if (const auto on = join(v)) {
    Vertex first = end;
    first.at = *on;
    first.turn = mission::Turn::Through;
    order.way.push_back(first);
  }
  order.way.push_back(end);
  order.within_m = 0.5;
  if (!path_->vehicle.steered()) {
    order.face_yaw_rad = goal_.yaw_rad;
    order.turn_radps = modes_->turn_radps;
  }
  state_ = State::Straight;
  trip_.begin(std::move(order), v, false);
}

void Dock::judge(const Vehicle& v) {
  const double off_m = base::distance_m(v.at, goal_.at);
  const double off_deg =
      std::abs(base::deg_from_rad(base::angle_diff_rad(v.yaw_rad, goal_.yaw_rad)));
  if (off_m <= modes_->dock_within_m && off_deg <= modes_->dock_within_deg) {
    state_ = State::Docked;
    return;
  }
  reason_ = "stands " + std::to_string(std::lround(off_m * 100.0)) + " cm and " +
            std::to_string(std::lround(off_deg)) + " degrees off";
  if (++tries_ >= 2) {
    state_ = State::Failed;
    return;
  }
  Trip::Order order;
  Vertex out;
  out.at = gate();
  out.reverse = !goal_.reverse;
  out.speed_mps = modes_->dock_mps;
  order.way.push_back(out);
  if (!path_->vehicle.steered()) {
    order.face_yaw_rad = goal_.yaw_rad;
    order.turn_radps = modes_->turn_radps;
  }
  state_ = State::BackOut;
  trip_.begin(std::move(order), v, false);
}

TrackOutput Dock::step(const Vehicle& v, double limit_mps, double dt_s) {
  if (state_ != State::ToGate && state_ != State::Straight && state_ != State::BackOut) return {};
  const TrackOutput out = trip_.step(v, limit_mps, dt_s);
  if (trip_.state() == Trip::State::Failed) {
    reason_ = trip_.reason();
    state_ = State::Failed;
  }
  if (trip_.state() != Trip::State::There) return out;
  if (state_ == State::Straight) {
    judge(v);
  } else {
    straight(v);
  }
  return out;
}

std::optional<double> Dock::distance_left_m() const noexcept {
  if (state_ == State::Docked) return 0.0;
  const auto left = trip_.distance_left_m();
  if (!left) return std::nullopt;
  return state_ == State::ToGate ? *left + straight_m() : *left;
}

}  // namespace roverd::nav
