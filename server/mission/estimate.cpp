// How long a mission takes: a walk through its items as they will be driven.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/checks.hpp"
#include "mission/circle.hpp"
#include "mission/fence/plane_lines.hpp"

namespace roverd::mission {

namespace {

class Walk {
 public:
  Walk(const Plan& plan, const VehicleLimits& vehicle)
      : plan_(plan),
        vehicle_(vehicle),
        left_(plan.items.size(), -1),
        speed_mps_(plan.settings.speed_mps.value_or(vehicle.default_speed_mps)) {}

  Estimate run() {
    // Loops within loops can be longer than anybody waits for.
    constexpr std::size_t kMostSteps = 1'000'000;
    std::size_t steps = 0;
    bool ends = true;
    for (std::size_t i = 0; i < plan_.items.size() && ends;) {
      if (++steps > kMostSteps) ends = false;
      if (const auto* jump = std::get_if<Jump>(&plan_.items[i])) {
        if (jump->times == 0) ends = false;
        i = next_after(*jump, i);
        continue;
      }
      std::visit([this](const auto& item) { pass(item); }, plan_.items[i]);
      ++i;
    }
    return result(ends);
  }

 private:
  std::size_t next_after(const Jump& jump, std::size_t i) {
    int& left = left_[i];
    if (left < 0) left = jump.times;
    if (left == 0) {
      left = -1;  // met again in an outer loop, it counts anew
      return i + 1;
    }
    --left;
    return static_cast<std::size_t>(jump.item) - 1;
  }

  /// At the end: back, or the same once more.
  Estimate result(bool ends) {
    Estimate out;
    switch (plan_.settings.at_end) {
      case AtEnd::Hold:
        break;
      case AtEnd::Return:
        pass(ReturnHome{});
        break;
      case AtEnd::Repeat:
      case AtEnd::BackAndForth:
        if (const int times = plan_.settings.times.value_or(0); times > 0) {
          length_m_ *= times;
          drive_s_ *= times;
          wait_s_ *= times;
        } else {
          ends = false;
        }
        break;
    }
    if (by_sight_) return out;
    out.length_m = length_m_;
    ends = ends && !endless_;
    if (!ends) return out;
    out.time_s = drive_s_ + wait_s_;
    if (vehicle_.drive_power_w) {
      constexpr double kSecondsInHour = 3600.0;
      const double idle_w = vehicle_.idle_power_w.value_or(0.0);
      out.energy_wh = (*vehicle_.drive_power_w * drive_s_ + idle_w * wait_s_) / kSecondsInHour;
    }
    return out;
  }

  void pass(const Waypoint& w) {
    go(w.at, w.speed_mps.value_or(speed_mps_));
    wait_s_ += w.hold_s.value_or(0.0);
  }
  void pass(const Local& local) {
    if (!plan_.home) return;
    if (!home_) home_.emplace(plan_.home->at);
    go(home_->to_global({local.east_m, local.north_m}), speed_mps_);
  }
  /// Where the map lies is known once the mission can be loaded.
  void pass(const MapPoint& point) {
    if (!plan_.frame || !plan_.frame->lies) {
      by_sight_ = true;
    } else {
      go(place_on_earth(*plan_.frame->lies, point), point.speed_mps.value_or(speed_mps_));
    }
    wait_s_ += point.hold_s.value_or(0.0);
  }
  void pass(const Move& move) { add_way(std::abs(move.forward_m), speed_mps_); }
  void pass(const TurnBy& turn) {
    const double turn_rad = base::rad_from_deg(std::abs(turn.turn_deg.value_or(90.0)));
    if (turn.radius_m) return add_way(turn_rad * *turn.radius_m, speed_mps_);
    turn_by(turn_rad);
  }
  void pass(const Wait& wait) { wait_s_ += wait.seconds; }
  void pass(const Speed& speed) { speed_mps_ = speed.speed_mps; }
  void pass(const ReturnHome&) {
    if (plan_.home) go(plan_.home->at, speed_mps_);
  }
  void pass(const Jump&) {}
  /// One that goes to its end shows on the way how long it is.
  void pass(const Row& row) { along(row.distance_m, row.speed_mps); }
  void pass(const Wall& wall) { along(wall.length_m, wall.speed_mps); }
  void pass(const Landmarks&) { by_sight_ = true; }
  void pass(const Dock&) { by_sight_ = true; }
  void along(const std::optional<double>& way_m, const std::optional<double>& speed_mps) {
    if (way_m) return add_way(*way_m, speed_mps.value_or(speed_mps_));
    by_sight_ = true;
  }
  void pass(const Action&) {}
  void pass(const Loiter& loiter) {
    if (const auto at = loiter.at()) go(*at, speed_mps_);
    if (loiter.seconds) wait_s_ += *loiter.seconds;
    if (!loiter.seconds) endless_ = true;
  }
  void pass(const Circle& circle) {
    const base::TangentPlane plane(circle.at);
    const auto before = at_ ? std::optional(plane.to_local(*at_)) : std::nullopt;
    const CircleWay round = circle_way(circle, {}, before);
    const double speed_mps = circle.speed_mps.value_or(speed_mps_);
    go(plane.to_global(round.entry()), speed_mps);
    if (way_ && !round.tangent) turn_by(base::kPi / 2.0);
    add_way(round.length_m(), speed_mps);
    const auto stations = static_cast<double>(stations_of(circle));
    wait_s_ += stations * circle.hold_s.value_or(0.0);
    if (stations > 0.0) drive_s_ += stations * base::kPi / vehicle_.yaw_rate_radps;
    at_ = plane.to_global(round.end());
    way_.reset();
  }

  void go(LatLon to, double speed_mps) {
    if (at_ && !(*at_ == to)) {
      const auto way = leg(*at_, to);
      add_way(std::hypot(way.east_m, way.north_m), speed_mps);
      if (way_ && vehicle_.turn_radius_m <= 0.0) {
        turn_by(std::abs(std::atan2(cross(*way_, way), dot(*way_, way))));
      }
      way_ = way;
    }
    at_ = to;
  }

  static EnuPoint leg(LatLon from, LatLon to) noexcept {
    const auto d = base::distance_bearing(from, to);
    const double yaw_rad = base::yaw_from_heading(d.bearing_deg);
    return {d.distance_m * std::cos(yaw_rad), d.distance_m * std::sin(yaw_rad)};
  }

  void turn_by(double turn_rad) {
    constexpr double kRounded_rad = 0.5;  // less is driven as a bend
    if (turn_rad > kRounded_rad) drive_s_ += turn_rad / vehicle_.yaw_rate_radps;
  }

  void add_way(double way_m, double speed_mps) {
    length_m_ += way_m;
    drive_s_ += way_m / std::min(speed_mps, vehicle_.max_speed_mps);
  }

  const Plan& plan_;
  const VehicleLimits& vehicle_;
  bool by_sight_ = false;  ///< how long it is nobody knows yet
  bool endless_ = false;   ///< stays somewhere until somebody says to go on
  std::vector<int> left_;  ///< repetitions left, by item; −1: not begun
  double speed_mps_;
  std::optional<base::TangentPlane> home_;
  std::optional<LatLon> at_;
  std::optional<EnuPoint> way_;
  double length_m_ = 0.0;
  double drive_s_ = 0.0;
  double wait_s_ = 0.0;
};

}  // namespace

Estimate estimate(const Plan& plan, const VehicleLimits& vehicle) {
  return Walk(plan, vehicle).run();
}

}  // namespace roverd::mission
