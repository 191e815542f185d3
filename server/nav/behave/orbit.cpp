#include "nav/behave/orbit.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/behave/text.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kLaidTurns = 4.0;
constexpr std::size_t kPointsATurn = 72;

}  // namespace

std::string Orbit::refusal(const OrbitGoal& goal) const {
  const double least_m = min_radius_m(path_->vehicle);
  if (goal.radius_m >= least_m) return {};
  return "the circle is too narrow for this vehicle: its radius must be at least " +
         tenths_text(least_m);
}

mission::CircleWay Orbit::way_of(const OrbitGoal& goal, EnuPoint here) {
  mission::Circle circle;
  circle.radius_m = goal.radius_m;
  circle.clockwise = goal.clockwise;
  circle.turns = goal.turns;
  return mission::circle_way(circle, goal.centre, here);
}

std::optional<EnuPoint> Orbit::lead_of(const mission::CircleWay& way, const VehicleParams& v) {
  if (!v.steered() || way.tangent) return std::nullopt;
  const double run_m = std::max(2.0, 1.5 * min_radius_m(v));
  const double yaw_rad = way.from_rad + (way.sweep_rad > 0.0 ? 0.5 : -0.5) * base::kPi;
  const EnuPoint on = way.entry();
  return EnuPoint{on.east_m - run_m * std::cos(yaw_rad), on.north_m - run_m * std::sin(yaw_rad)};
}

void Orbit::begin(const OrbitGoal& goal, const Vehicle& v) {
  goal_ = goal;
  const double laid = std::min(goal.turns.value_or(kLaidTurns), kLaidTurns);
  const double more = std::ceil(goal.turns.value_or(kLaidTurns) - kLaidTurns);
  more_turns_.reset();
  if (goal.turns) more_turns_ = static_cast<std::size_t>(std::max(0.0, more));
  OrbitGoal part = goal;
  part.turns = goal.turns && more > 0.0 ? *goal.turns - more : laid;
  const mission::CircleWay way = way_of(part, v.at);
  const bool steered = path_->vehicle.steered();
  const double side = way.sweep_rad > 0.0 ? 1.0 : -1.0;
  Vertex on;
  on.at = way.entry();
  on.speed_mps = std::min(goal.speed_mps.value_or(path_->speed.default_mps), path_->speed.max_mps);
  Trip::Order order;
  if (const auto lead_at = lead_of(way, path_->vehicle)) {
    Vertex lead = on;
    lead.at = *lead_at;
    order.way.push_back(lead);
  }
  on.tangent = way.tangent || steered;
  on.stop = !on.tangent;
  first_ = order.way.size();
  order.way.push_back(on);
  // From the end backwards, so that a whole turn has the same points each time.
  const double turn_rad = std::abs(way.sweep_rad);
  const double piece_rad = 2.0 * base::kPi / kPointsATurn;
  const auto pieces = static_cast<std::size_t>(std::ceil(turn_rad / piece_rad - 1e-9));
  on.curvature_1pm = side / way.radius_m;
  on.tangent = true;
  on.stop = false;
  for (std::size_t left = pieces; left-- > 0;) {
    on.at = way.at(side * (turn_rad - piece_rad * static_cast<double>(left)));
    order.way.push_back(on);
  }
  trip_.begin(std::move(order), v, false);
  state_ = State::Driving;
}

void Orbit::interrupt() noexcept {
  trip_.interrupt();
}

TrackOutput Orbit::step(const Vehicle& v, double limit_mps, double dt_s) {
  if (state_ != State::Driving) return {};
  const bool more = !more_turns_ || *more_turns_ > 0;
  if (more && trip_.again(first_ + 1, kPointsATurn) && more_turns_) --*more_turns_;
  const TrackOutput out = trip_.step(v, limit_mps, dt_s);
  if (trip_.state() == Trip::State::There) state_ = State::Done;
  if (trip_.state() == Trip::State::Failed) state_ = State::Failed;
  return out;
}

std::optional<double> Orbit::distance_left_m() const noexcept {
  const auto left_m = trip_.distance_left_m();
  if (!more_turns_ || !left_m) return std::nullopt;
  return *left_m + static_cast<double>(*more_turns_) * 2.0 * base::kPi * goal_.radius_m;
}

}  // namespace roverd::nav
