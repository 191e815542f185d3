// What a drill is told, and the place on the way that it means.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"
#include "mission/fence/fence_json.hpp"
#include "mission/json/json.hpp"
#include "mission/json/object.hpp"
#include "nav/behave/route.hpp"
#include "study/drill.hpp"

namespace roverd::study {
namespace {

using base::Result;
using nlohmann::json;

constexpr double kFarthestAt_m = 1e7;
constexpr double kShortestWay_m = 1.0;
constexpr double kRunUp_m =
    6.0;  // beside the way of speeding up: to find its heading, and to settle
constexpr double kRunUp_s = 4.0;
const base::WallTime kDrillWall{std::chrono::seconds(1'780'000'000)};

tl::unexpected<base::Error> bad(std::string pointer, std::string detail) {
  std::string sentence = pointer + " " + detail;
  return base::fail(base::Code::Invalid, std::move(sentence),
                    {{std::move(pointer), std::move(detail)}});
}

/// @param pointer is put before the places that the error names.
tl::unexpected<base::Error> inside(const std::string& pointer, base::Error error) {
  for (auto& field : error.fields) field.pointer.insert(0, pointer);
  if (error.fields.empty()) error.fields.push_back({pointer, error.detail});
  error.detail.insert(0, pointer + ": ");
  return tl::unexpected(std::move(error));
}

Result<Settings> read_settings(const json* value) {
  if (value == nullptr || !value->is_object()) return bad("/settings", "must be an object");
  std::vector<robot::NamedValue> values;
  for (const auto& [key, one] : value->items()) {
    if (one.is_boolean()) {
      values.emplace_back(key, one.get<bool>());
    } else if (one.is_number()) {
      values.emplace_back(key, one.get<double>());
    } else if (one.is_string()) {
      values.emplace_back(key, one.get<std::string>());
    } else {
      return bad("/settings/" + key, "must be a number, a text or true/false");
    }
  }
  auto settings = settings_from(values);
  if (!settings) return inside("/settings", settings.error());
  return settings;
}

Result<robot::MissionCopy> read_copy(const json* value) {
  if (value == nullptr || !value->is_object()) return bad("/mission", "must be an object");
  mission::Members members(*value, "/mission");
  members.require("id");
  members.require("revision");
  members.require("plan");
  const auto id = members.text("id");
  const auto revision = members.whole("revision", 1, 1'000'000'000);
  const json* plan = members.any("plan");
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  auto read = mission::plan_from_json(*plan);
  if (!read) return inside("/mission/plan", read.error());
  return robot::MissionCopy{*id, *revision, std::move(*read)};
}

Result<std::optional<base::LatLon>> read_point(const json* value, const std::string& pointer) {
  if (value == nullptr) return std::nullopt;
  if (!value->is_object()) return bad(pointer, "must be an object with lat and lon");
  mission::Members members(*value, pointer);
  members.require("lat");
  members.require("lon");
  const auto lat = members.number("lat", -90.0, 90.0);
  const auto lon = members.number("lon", -180.0, 180.0);
  if (auto good = members.finish(); !good) return tl::unexpected(good.error());
  return base::LatLon{*lat, *lon};
}

Result<std::vector<std::string_view>> read_failures(const json* value) {
  std::vector<std::string_view> out;
  if (value == nullptr) return out;
  if (!value->is_array()) return bad("/failures", "must be a list");
  for (std::size_t i = 0; i < value->size(); ++i) {
    const json& one = (*value)[i];
    const auto* known =
        one.is_string() ? base::drill_failure(one.get_ref<const std::string&>()) : nullptr;
    if (known == nullptr) return bad("/failures/" + std::to_string(i), "is no failure's name");
    out.push_back(known->id);
  }
  return out;
}

/// What the members that are documents of their own say.
Result<void> read_parts(DrillOrder& order, const json* settings, const json* copy,
                        const json* fence) {
  auto told = read_settings(settings);
  if (!told) return tl::unexpected(told.error());
  order.settings = std::move(*told);
  auto read = read_copy(copy);
  if (!read) return tl::unexpected(read.error());
  order.mission = std::move(*read);
  if (fence == nullptr) return {};
  auto limits = mission::fence_from_json(*fence);
  if (!limits) return inside("/fence", limits.error());
  order.fence = std::make_shared<const mission::Fence>(std::move(*limits));
  return {};
}

Result<void> read_plant(DrillOrder& order, const std::string& file) {
  sim::Config config;
  if (auto good = sim::read_config_file(config, file); !good) {
    return base::fail(good.error().code, "the vehicle \"" + order.settings.vehicle.name +
                                             "\" cannot be simulated: " + good.error().detail);
  }
  order.plant = config.params;
  return {};
}

/// Local items count from the mission's home, else from the origin of the robot's map: the
/// simulated robot's begins elsewhere.
void anchor_locals(DrillOrder& order) {
  mission::Plan& plan = order.mission.plan;
  const bool locals = std::any_of(plan.items.begin(), plan.items.end(), [](const auto& item) {
    return std::holds_alternative<mission::Local>(item);
  });
  if (locals && !plan.home && order.origin) plan.home.emplace().at = *order.origin;
}

/// Where its map begins: any place near the way does.
base::LatLon near_the_way(const DrillOrder& order) {
  for (const auto& item : order.mission.plan.items) {
    if (const auto* w = std::get_if<mission::Waypoint>(&item)) return w->at;
  }
  const auto& home = order.mission.plan.home;
  return home ? home->at : order.origin.value_or(base::LatLon{});
}

/// Of the plan: between two points it speeds up from one, brakes for the next, and keeps the limit.
double planned_mps(const nav::Path& path, double s_m, const nav::SpeedParams& speed) {
  const auto after =
      std::lower_bound(path.points.begin(), path.points.end(), s_m,
                       [](const nav::PathPoint& p, double at_m) { return p.s_m < at_m; });
  if (after == path.points.begin()) return after->plan_mps;
  if (after == path.points.end()) return path.points.back().plan_mps;
  const nav::PathPoint& before = *std::prev(after);
  const double since_m = s_m - before.s_m;
  const double left_m = after->s_m - s_m;
  const double v0 = before.plan_mps;
  const double v1 = after->plan_mps;
  return std::min({before.segment_mps, std::sqrt(v0 * v0 + 2.0 * speed.accel_mps2 * since_m),
                   std::sqrt(v1 * v1 + 2.0 * speed.decel_mps2 * left_m)});
}

}  // namespace

Result<DrillOrder> read_drill(std::string_view text) {
  const auto whole = mission::parse_json(text);
  if (!whole) return tl::unexpected(whole.error());
  if (!whole->is_object()) return bad("", "must be an object");
  mission::Members members(*whole);
  members.require("sim");
  const json* settings = members.any("settings");
  const auto plant = members.text("sim");
  const json* copy = members.any("mission");
  const json* fence = members.any("fence");
  const json* home = members.any("home");
  const json* origin = members.any("origin");
  const json* failures = members.any("failures");
  DrillOrder order;
  order.at_m = members.number("at_m", 0.0, kFarthestAt_m);
  order.limit_s = members.number("limit_s", base::kDrillLimitMin_s, base::kDrillLimitMax_s)
                      .value_or(order.limit_s);
  if (auto good = members.finish("the order"); !good) return tl::unexpected(good.error());
  if (auto good = read_parts(order, settings, copy, fence); !good) {
    return tl::unexpected(good.error());
  }
  auto at_home = read_point(home, "/home");
  if (!at_home) return tl::unexpected(at_home.error());
  order.home = *at_home;
  auto at_origin = read_point(origin, "/origin");
  if (!at_origin) return tl::unexpected(at_origin.error());
  order.origin = *at_origin;
  auto named = read_failures(failures);
  if (!named) return tl::unexpected(named.error());
  order.failures = std::move(*named);
  if (auto good = read_plant(order, *plant); !good) return tl::unexpected(good.error());
  anchor_locals(order);
  return order;
}

Result<DrillPlace> place_of(const DrillOrder& order) {
  DrillPlace place{base::LocalFrame(1, near_the_way(order)), {}, 0.0, 0.0, 0.0, 0.0, {}};
  const nav::PathParams params = order.settings.robot.path();
  auto route = nav::lay_route(order.mission.plan, place.frame, params);
  if (!route) return tl::unexpected(route.error());
  place.path = std::move(route->forth.path);
  place.length_m = place.path.length_m();
  if (place.path.legs.empty() || place.length_m < kShortestWay_m) {
    return bad("/mission_id", "has no way between its points on which something could fail");
  }
  place.at_m = order.at_m.value_or(0.5 * place.length_m);
  if (place.at_m > place.length_m) {
    return bad("/at_m", "lies behind the way's end: it is " +
                            std::to_string(std::lround(place.length_m)) + " m long");
  }
  place.speed_mps = planned_mps(place.path, place.at_m, params.speed);
  const double v = std::max(place.speed_mps, params.speed.default_mps);
  const double before_m = kRunUp_m + kRunUp_s * v + v * v / (2.0 * params.speed.accel_mps2);
  place.from_m = std::max(0.0, place.at_m - before_m);
  const std::size_t at = std::min(place.path.leg_from(place.from_m), place.path.legs.size() - 1);
  const nav::Leg& leg = place.path.legs[at];
  const double way_rad = place.path.yaw_rad(leg, place.from_m, leg.first);
  const double yaw_rad = leg.reverse ? base::wrap_rad(way_rad + base::kPi) : way_rad;
  place.start = {place.frame.to_global(place.path.at(place.from_m)),
                 base::heading_from_yaw(yaw_rad),
                 {},
                 kDrillWall};
  return place;
}

}  // namespace roverd::study
