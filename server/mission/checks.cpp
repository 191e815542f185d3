#include "mission/checks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/circle.hpp"
#include "mission/fence/plane_lines.hpp"
#include "mission/guarded.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

namespace {

constexpr double kReach_m = base::LocalFrame::kReach_m;
constexpr double kFar_m = 1000.0;
constexpr double kLongLeg_m = 1000.0;
constexpr double kDuplicate_m = 0.01;

/// "12.3", for people.
std::string tenths(double value) {
  return fixed_number(std::round(value * 10.0) / 10.0, 1);
}

/// Where the way of an item lies, for the fence.
struct Round {
  int item = 0;
  CircleWay way;
};

/// A place the mission leads to, in order.
struct Target {
  int item = 0;
  EnuPoint at;
  const Waypoint* waypoint = nullptr;
  bool after_break = false;  ///< the way from the target before is not a straight leg
};

class PlanCheck {
 public:
  PlanCheck(const Plan& plan, const VehicleLimits& vehicle, const Surroundings& around)
      : plan_(plan), vehicle_(vehicle), around_(around) {}

  CheckReport run() {
    types();
    targets();
    const bool drives = std::any_of(plan_.items.begin(), plan_.items.end(), drives_from_anywhere);
    if (targets_.empty() && !drives && !nowhere_) {
      add(Severity::Error, "no_target", 0, "the mission leads nowhere");
    }
    distances();
    legs();
    turns();
    fence();
    for (Finding& f : guarded_findings(plan_, vehicle_)) {
      add(f.severity, f.code.c_str(), *f.item, std::move(f.detail));
    }
    auto& all = report_.findings;
    std::stable_sort(all.begin(), all.end(), [](const Finding& a, const Finding& b) {
      if (a.severity != b.severity) return a.severity == Severity::Error;
      return a.item.value_or(0) < b.item.value_or(0);
    });
    if (all.size() > kMaxFindings) all.resize(kMaxFindings);
    report_.estimate = estimate(plan_, vehicle_);
    return std::move(report_);
  }

 private:
  /// @param item from 1; 0: the mission as a whole
  void add(Severity severity, const char* code, int item, std::string detail) {
    ++(severity == Severity::Error ? report_.errors : report_.warnings);
    if (report_.findings.size() >= 4 * kMaxFindings) return;
    report_.findings.push_back({severity, code,
                                item > 0 ? "/items/" + std::to_string(item - 1) : "/items",
                                item > 0 ? std::optional(item) : std::nullopt, std::move(detail)});
  }

  void types() {
    for (std::size_t i = 0; i < plan_.items.size(); ++i) {
      const Item& item = plan_.items[i];
      const int number = static_cast<int>(i) + 1;
      const std::string_view type = type_name(item);
      const auto& known = vehicle_.item_types;
      if (std::find(known.begin(), known.end(), type) == known.end()) {
        add(Severity::Error, "unreachable_type", number, why_not_drivable(type));
      }
      if (const auto* action = std::get_if<Action>(&item)) {
        std::string why = why_not_done(action->name, vehicle_.actions);
        if (!why.empty()) add(Severity::Error, "unknown_action", number, std::move(why));
      }
      if (const auto* jump = std::get_if<Jump>(&item); jump != nullptr && jump->times == 0) {
        add(Severity::Warning, "repeats_for_ever", number,
            "jumps to item " + std::to_string(jump->item) + " for ever");
      }
      if (std::holds_alternative<Local>(item) && !plan_.home) {
        nowhere_ = true;
        add(Severity::Error, "no_target", number,
            "counts from the mission's home, and the mission has none");
      }
      if (const auto* point = std::get_if<MapPoint>(&item)) {
        speed_limit(number, point->speed_mps.value_or(0.0));
      }
      if (const auto* speed = std::get_if<Speed>(&item)) speed_limit(number, speed->speed_mps);
      if (const auto* circle = std::get_if<Circle>(&item)) this->circle(number, *circle);
      if (const auto* turn = std::get_if<TurnBy>(&item)) this->turn(number, *turn);
    }
    if (plan_.settings.speed_mps) speed_limit(0, *plan_.settings.speed_mps);
  }

  void speed_limit(int item, double speed_mps) {
    if (!(speed_mps > vehicle_.max_speed_mps + 1e-9)) return;
    add(Severity::Warning, "speed_above_limit", item,
        "asks for " + tenths(speed_mps) + " m/s; " + tenths(vehicle_.max_speed_mps) +
            " m/s will be driven");
  }

  void turn(int item, const TurnBy& turn) {
    if (!(vehicle_.turn_radius_m > 0.0)) return;
    if (!turn.radius_m) {
      add(Severity::Error, "turn_too_tight", item,
          "is a turn on the spot: this vehicle cannot; with a radius_m it is driven as an arc");
    } else if (*turn.radius_m < vehicle_.turn_radius_m) {
      add(Severity::Error, "turn_too_tight", item,
          "is a turn with a radius of " + tenths(*turn.radius_m) +
              " m; this vehicle's turning radius is " + tenths(vehicle_.turn_radius_m) + " m");
    }
  }

  void circle(int item, const Circle& circle) {
    speed_limit(item, circle.speed_mps.value_or(0.0));
    if (!(vehicle_.turn_radius_m > 0.0)) return;
    if (circle.radius_m < vehicle_.turn_radius_m) {
      add(Severity::Error, "turn_too_tight", item,
          "is a circle with a radius of " + tenths(circle.radius_m) +
              " m; this vehicle's turning radius is " + tenths(vehicle_.turn_radius_m) + " m");
    }
    if (stations_of(circle) > 0) {
      add(Severity::Error, "turn_too_tight", item,
          "has stations at which to turn to the centre on the spot: this vehicle cannot");
    }
  }

  std::optional<LatLon> first_place() const {
    for (const Item& item : plan_.items) {
      if (const auto at = place_of(item)) return at;
    }
    return plan_.home ? std::optional(plan_.home->at) : std::nullopt;
  }

  /// Its entry and its end; nothing leads straight from one to the other.
  void round(Target target, const Circle& circle, const base::TangentPlane& plane, bool broken) {
    const bool known = !targets_.empty() && !broken;
    const auto before = known ? std::optional(targets_.back().at)
                        : targets_.empty() && plan_.home
                            ? std::optional(plane.to_local(plan_.home->at))
                            : std::nullopt;
    const CircleWay way = circle_way(circle, plane.to_local(circle.at), before);
    rounds_.push_back({target.item, way});
    target.at = way.entry();
    targets_.push_back(target);
    target.at = way.end();
    target.after_break = true;
    targets_.push_back(target);
  }

  void targets() {
    if (plan_.home) home_.emplace(plan_.home->at);
    const auto origin = around_.vehicle ? around_.vehicle : first_place();
    if (!origin) return;
    frame_.emplace(1, *origin);
    const base::TangentPlane plane(*origin);
    bool broken = false;
    for (std::size_t i = 0; i < plan_.items.size(); ++i) {
      const Item& item = plan_.items[i];
      Target target{static_cast<int>(i) + 1, {}, std::get_if<Waypoint>(&item), broken};
      if (const auto place = place_of(item)) {
        const double far_m = base::distance_bearing(*origin, *place).distance_m;
        if (far_m > kReach_m) {
          add(Severity::Error, "too_far", target.item,
              "lies " + tenths(far_m / 1000.0) + " km from " +
                  (around_.vehicle ? "the vehicle" : "the first position") +
                  "; at most 10 km are possible");
          broken = true;
          continue;
        }
        if (const auto* circle = std::get_if<Circle>(&item)) {
          round(target, *circle, plane, broken);
          broken = false;
          continue;
        }
        target.at = plane.to_local(*place);
        if (target.waypoint != nullptr) {
          speed_limit(target.item, target.waypoint->speed_mps.value_or(0.0));
        }
      } else if (const auto* point = std::get_if<MapPoint>(&item);
                 point != nullptr && plan_.frame && plan_.frame->lies) {
        target.at = plane.to_local(place_on_earth(*plan_.frame->lies, *point));
      } else if (const auto* local = std::get_if<Local>(&item); local != nullptr && home_) {
        target.at = plane.to_local(home_->to_global({local->east_m, local->north_m}));
      } else {
        broken = broken || leads_elsewhere(item);
        continue;
      }
      targets_.push_back(target);
      broken = false;
    }
  }

  static bool leads_elsewhere(const Item& item) {
    return !std::holds_alternative<Wait>(item) && !std::holds_alternative<Speed>(item) &&
           !std::holds_alternative<Action>(item) && !std::holds_alternative<Loiter>(item);
  }

  /// From wherever the robot stands, or to a place that only the robot knows: no other is needed.
  static bool drives_from_anywhere(const Item& item) {
    return std::holds_alternative<Move>(item) || std::holds_alternative<TurnBy>(item) ||
           std::holds_alternative<Row>(item) || std::holds_alternative<Wall>(item) ||
           std::holds_alternative<Landmarks>(item) || std::holds_alternative<Dock>(item) ||
           std::holds_alternative<MapPoint>(item);
  }

  void distances() {
    if (!around_.vehicle || targets_.empty()) return;
    const double first_m = base::distance_m(targets_.front().at, {});
    if (first_m > kFar_m) {
      add(Severity::Warning, "too_far", targets_.front().item,
          "lies " + tenths(first_m / 1000.0) + " km from the vehicle");
    }
  }

  void legs() {
    for (std::size_t i = 1; i < targets_.size(); ++i) {
      const Target& from = targets_[i - 1];
      const Target& to = targets_[i];
      if (to.after_break) continue;
      const double leg_m = base::distance_m(from.at, to.at);
      if (leg_m > kLongLeg_m) {
        add(Severity::Warning, "leg_too_long", to.item,
            "lies " + tenths(leg_m / 1000.0) + " km from item " + std::to_string(from.item));
      } else if (leg_m < kDuplicate_m) {
        add(Severity::Warning, "duplicate_point", to.item,
            "is the same place as item " + std::to_string(from.item));
      }
      climb(from, to, leg_m);
    }
  }

  void climb(const Target& from, const Target& to, double leg_m) {
    constexpr double kShortest_m = 0.5;  // below, heights are noise
    if (from.waypoint == nullptr || to.waypoint == nullptr || leg_m < kShortest_m) return;
    if (!from.waypoint->alt_m || !to.waypoint->alt_m) return;
    const double rise_m = *to.waypoint->alt_m - *from.waypoint->alt_m;
    const double slope_deg = base::deg_from_rad(std::atan2(std::abs(rise_m), leg_m));
    if (slope_deg <= vehicle_.max_climb_deg) return;
    add(Severity::Error, "too_steep", to.item,
        "is reached by a slope of " + tenths(slope_deg) + " deg; the vehicle can do " +
            tenths(vehicle_.max_climb_deg));
  }

  /// Length of leg that a corner takes: the tangent of its arc and the way on which the steering
  /// turns. 0: straight on.
  double corner_m(std::size_t at) const {
    constexpr double kStraight_rad = 0.1;
    constexpr double kSharpest_rad = 2.6;  // 149 deg: beyond, a loop is needed anyway
    if (at == 0 || at + 1 >= targets_.size() || targets_[at].after_break ||
        targets_[at + 1].after_break) {
      return 0.0;
    }
    const EnuPoint in = targets_[at].at - targets_[at - 1].at;
    const EnuPoint out = targets_[at + 1].at - targets_[at].at;
    const double turn_rad = std::abs(std::atan2(cross(in, out), dot(in, out)));
    if (turn_rad < kStraight_rad) return 0.0;
    return vehicle_.turn_radius_m * std::tan(std::min(turn_rad, kSharpest_rad) / 2.0) +
           vehicle_.steer_in_m;
  }

  void turns() {
    if (!(vehicle_.turn_radius_m > 0.0)) return;
    double before_m = 0.0;
    for (std::size_t i = 1; i < targets_.size(); ++i) {
      const Target& to = targets_[i];
      const double after_m = corner_m(i);
      const double needed_m = before_m + (before_m > 0.0 ? vehicle_.settle_m : 0.0) + after_m;
      const double leg_m = base::distance_m(targets_[i - 1].at, to.at);
      if (!to.after_break && leg_m >= kDuplicate_m && leg_m < needed_m) {
        add(Severity::Warning, "turn_too_tight", to.item,
            "is reached by a leg of " + tenths(leg_m) + " m; its corners need " + tenths(needed_m) +
                " m with a turning radius of " + tenths(vehicle_.turn_radius_m) + " m");
      }
      if (to.waypoint != nullptr && to.waypoint->turn == Turn::Pivot) {
        add(Severity::Error, "turn_too_tight", to.item,
            "asks for a turn on the spot: this vehicle cannot");
      }
      before_m = after_m;
    }
  }

  void fence() {
    if (around_.fence == nullptr || !frame_) return;
    const CompiledFence limits(*around_.fence, *frame_);
    if (limits.empty()) return;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const Target& to = targets_[i];
      const bool leg = i > 0 && !to.after_break;
      const double room_m =
          leg ? limits.clearance_m(targets_[i - 1].at, to.at) : limits.clearance_m(to.at);
      if (!(room_m > 0.0)) {
        const bool itself = !limits.contains(to.at);
        if (leg && !itself && !limits.contains(targets_[i - 1].at)) continue;  // told already
        add(Severity::Error, "outside_fence", to.item,
            itself ? "lies outside the fence" : "is reached by a way that leaves the fence");
      } else if (room_m < vehicle_.width_m / 2.0) {
        add(Severity::Warning, "near_fence", to.item,
            "is reached " + tenths(room_m) +
                " m from the fence, less than half the vehicle's width");
      }
    }
    for (const Round& round : rounds_) around(round, limits);
  }

  /// Chords outside of the arc, so that none of it is farther out.
  void around(const Round& round, const CompiledFence& limits) {
    constexpr double kChord_rad = 0.05;
    const double sweep_rad = std::clamp(round.way.sweep_rad, -2.0 * base::kPi, 2.0 * base::kPi);
    const double pieces = std::ceil(std::abs(sweep_rad) / kChord_rad);
    CircleWay outside = round.way;
    outside.radius_m /= std::cos(0.5 * kChord_rad);
    double room_m = 1e300;
    for (double i = 0.0; i < pieces; i += 1.0) {
      room_m = std::min(room_m, limits.clearance_m(outside.at(sweep_rad * i / pieces),
                                                   outside.at(sweep_rad * (i + 1.0) / pieces)));
    }
    if (!(room_m > 0.0)) {
      add(Severity::Error, "outside_fence", round.item, "leaves the fence on its way round");
    } else if (room_m < vehicle_.width_m / 2.0) {
      add(Severity::Warning, "near_fence", round.item,
          "comes to " + tenths(room_m) +
              " m from the fence on its way round, less than half the vehicle's width");
    }
  }

  const Plan& plan_;
  const VehicleLimits& vehicle_;
  const Surroundings& around_;
  CheckReport report_;
  bool nowhere_ = false;  ///< told of an item
  std::optional<base::TangentPlane> home_;
  std::optional<base::LocalFrame> frame_;
  std::vector<Target> targets_;
  std::vector<Round> rounds_;
};

}  // namespace

std::string_view to_string(Severity severity) noexcept {
  switch (severity) {
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      return "error";
  }
  return "error";
}

std::string sentence(const Finding& finding) {
  if (!finding.item) return finding.detail;
  return "item " + std::to_string(*finding.item) + " " + finding.detail;
}

std::string why_not_done(std::string_view action, const std::vector<std::string>& built_in) {
  if (std::find(built_in.begin(), built_in.end(), action) != built_in.end()) return {};
  std::string why =
      "asks for the action \"" + std::string(action) + "\", which nothing here does; ";
  if (built_in.empty()) return why + "no action is built in";
  why += "built in: ";
  for (const std::string& name : built_in) why += (&name == &built_in.front() ? "" : ", ") + name;
  return why;
}

std::string why_not_drivable(std::string_view type) {
  const std::string item = "cannot be driven: ";
  if (type == "row") return item + "no scanner that sees rows is configured";
  if (type == "wall") return item + "no scanner or camera that sees walls is configured";
  if (type == "landmarks") return item + "no scanner or camera that sees landmarks is configured";
  if (type == "dock") return item + "no camera that reads tags is configured";
  if (type == "map_point") {
    return item + "no sensor that finds the robot in a map is configured";
  }
  return item + "items of type " + std::string(type) + " are not available yet";
}

CheckReport check(const Plan& plan, const VehicleLimits& vehicle, const Surroundings& around) {
  return PlanCheck(plan, vehicle, around).run();
}

}  // namespace roverd::mission
