// What a start would do, and the way that would be driven.

#include <algorithm>

#include "nav/behave/stops.hpp"
#include "nav/track/outline.hpp"
#include "nav/track/pace.hpp"
#include "robot/impl.hpp"

namespace roverd::robot {

using base::Code;

namespace {

/// Nobody sees less on a map.
constexpr double kOutline_m = 0.01;

WayStop told_stop(const nav::CourseStop& stop, const base::LocalFrame& frame) {
  WayStop out{frame.to_global(stop.at), stop.s_m, stop.item};
  for (const nav::TurnOnTheSpot& t : stop.turns) {
    out.turns.push_back({t.from_yaw_rad, t.to_yaw_rad, t.by_rad, t.above_rad});
  }
  return out;
}

/// @param speed of now: they lay the way anew when they change, unless it is in hand
void tell_pace(const CompiledMission& mission, const nav::SpeedParams& speed, MissionWay& out) {
  const nav::Course& course = mission.route.forth;
  std::vector<int> items;
  items.reserve(course.nodes.size());
  for (const nav::RouteNode& node : course.nodes) items.push_back(node.item);
  for (const nav::PacePoint& p :
       nav::pace_of(course.path, items, speed, {kOutline_m, 2.0 * kOutline_m, kWayPoints})) {
    out.pace.push_back(
        {mission.frame.to_global(p.at), p.s_m, p.planned_mps, p.set_mps, p.item, p.reverse});
  }
  const nav::CourseStops found = nav::stops_of(course, kWayPoints);
  for (const nav::CourseStop& stop : found.stops) {
    out.stops.push_back(told_stop(stop, mission.frame));
  }
  out.stops_left_out = found.left_out;
}

}  // namespace

std::vector<SmoothedItems> smoothed_items(const CompiledMission& mission) {
  const nav::Course& course = mission.route.forth;
  std::vector<SmoothedItems> out;
  for (const nav::SmoothStretch& s : course.path.smoothed) {
    out.push_back({course.nodes[s.first].item, course.nodes[s.last].item, s.deviation_m});
  }
  const std::size_t shown = std::min(out.size(), kSmoothedShown);
  std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(shown), out.end(),
                    [](const auto& a, const auto& b) { return a.deviation_m > b.deviation_m; });
  out.resize(shown);
  return out;
}

base::Result<Preview> Robot::preview(const StartMission& start) const {
  const auto mission = impl_->loaded.get();
  if (!mission) return base::fail(Code::NotFound, "no mission is loaded");
  const auto state = impl_->snapshot.get();
  const nav::Route& route = mission->route;
  std::optional<nav::Stand> stand;
  std::optional<base::EnuPoint> home;
  if (state && state->pose) stand = stand_of(*state->pose);
  if (state && state->home) home = mission->frame.to_local(*state->home);
  const auto config = impl_->shared_config.get();
  const nav::Beginning begins =
      nav::beginning(route, start_at(start), stand, home, config->path(), config->behave);
  const std::size_t step = begins.joins ? begins.joins->step : begins.step;
  if (step >= route.forth.steps.size()) {
    return base::fail(Code::Conflict, "item " + std::to_string(start.item) +
                                          " has nothing to drive to; the mission has " +
                                          std::to_string(route.items) + " items");
  }
  Preview p;
  p.mission_id = mission->copy.id;
  p.revision = mission->copy.revision;
  p.name = mission->copy.plan.name;
  p.first_item = route.forth.steps[step].item;
  p.speed_mps = route.speed_mps;
  p.at_end = route.at_end;
  for (std::size_t i = step; i < route.forth.steps.size(); ++i) {
    if (route.forth.steps[i].kind != nav::StepKind::Go) continue;
    p.speed_mps = route.forth.nodes[route.forth.steps[i].node].speed_mps;
    break;
  }
  p.speed_mps = std::min(p.speed_mps, config->path().speed.max_mps);
  if (begins.joins) {
    p.joins_after_m = begins.joins->skips_m;
    p.left_out = begins.joins->left_out;
  }
  if (begins.target) {
    p.first_target = mission->frame.to_global(*begins.target);
    if (state && state->pose) {
      const auto to = base::distance_bearing(state->pose->global, *p.first_target);
      p.distance_m = to.distance_m;
      p.bearing_deg = to.bearing_deg;
    }
  }
  p.smoothed = smoothed_items(*mission);
  return p;
}

std::optional<MissionWay> Robot::mission_way() const {
  const auto mission = impl_->loaded.get();
  if (!mission) return std::nullopt;
  const nav::Path& path = mission->route.forth.path;
  const nav::Outline drawn = nav::outline(path, kOutline_m, kWayPoints);
  MissionWay out{mission->copy.id, mission->copy.revision, path.length_m(), drawn.within_m};
  out.line.reserve(drawn.points.size());
  for (const base::EnuPoint at : drawn.points) out.line.push_back(mission->frame.to_global(at));
  tell_pace(*mission, impl_->shared_config.get()->path().speed, out);
  return out;
}

}  // namespace roverd::robot
