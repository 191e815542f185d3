#include "robot/safety/fence_guard.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

constexpr double kNoise_m = 0.01;  // of the position beside a limit

using mission::Finding;

Finding outside_at(int item, const char* detail) {
  return {mission::Severity::Error, "outside_fence", "/items/" + std::to_string(item - 1), item,
          detail};
}

Finding leg_outside(const nav::RouteNode& node, const mission::CompiledFence& limits) {
  return outside_at(node.item, limits.contains(node.at)
                                   ? "is reached by a way that leaves the fence"
                                   : "lies outside the fence");
}

/// The first point that is not inside, as the item that the way leads to.
std::optional<Finding> first_outside(const nav::Course& course,
                                     const mission::CompiledFence& limits, double margin_m) {
  const nav::Path& path = course.path;
  if (!course.nodes.empty() && limits.clearance_m(course.nodes.front().at) < margin_m) {
    return leg_outside(course.nodes.front(), limits);
  }
  std::size_t node = 0;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const nav::PathPoint& a = path.points[i];
    while (node + 1 < path.vertex_m.size() && path.vertex_m[node] < a.s_m + 1e-6) ++node;
    if (limits.clearance_m(a.at, path.points[i + 1].at) < margin_m) {
      return leg_outside(course.nodes[node], limits);
    }
  }
  if (path.points.empty()) {
    for (const nav::RouteNode& n : course.nodes) {
      if (limits.clearance_m(n.at) < margin_m) return leg_outside(n, limits);
    }
  }
  return std::nullopt;
}

/// The straight ways that are not on the path: of jumps, and to the first waypoint once more.
std::optional<Finding> link_outside(const nav::Route& route, const mission::CompiledFence& limits,
                                    double margin_m) {
  const nav::Course& course = route.forth;
  const auto go_from = [&course](std::size_t step) {
    while (step < course.steps.size() && course.steps[step].kind != nav::StepKind::Go) ++step;
    return step;
  };
  std::optional<base::EnuPoint> before;
  for (const nav::RouteStep& step : course.steps) {
    if (step.kind == nav::StepKind::Go) before = course.nodes[step.node].at;
    if (step.moves_on() || step.kind == nav::StepKind::Home) before.reset();
    if (step.kind != nav::StepKind::Jump || !before) continue;
    const std::size_t to = go_from(step.target);
    if (to == course.steps.size()) continue;
    if (limits.clearance_m(*before, course.nodes[course.steps[to].node].at) < margin_m) {
      return outside_at(step.item, "jumps over a way that leaves the fence");
    }
  }
  const bool again = route.at_end == mission::AtEnd::Repeat && route.times != 1;
  if (!again || course.nodes.empty()) return std::nullopt;
  if (limits.clearance_m(course.nodes.back().at, course.nodes.front().at) < margin_m) {
    return Finding{mission::Severity::Error, "outside_fence", "/settings/at_end", std::nullopt,
                   "the way back to the first item leaves the fence"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Finding> route_objection(const nav::Route& route,
                                       const mission::CompiledFence& limits, double margin_m) {
  if (limits.empty()) return std::nullopt;
  if (auto found = first_outside(route.forth, limits, margin_m)) return found;
  if (auto found = first_outside(route.back, limits, margin_m)) return found;
  return link_outside(route, limits, margin_m);
}

bool may_drive(const mission::CompiledFence& limits, base::EnuPoint from, base::EnuPoint to,
               double margin_m) noexcept {
  if (limits.empty()) return true;
  const double here_m = limits.clearance_m(from);
  if (!(here_m > 0.0)) return false;
  if (here_m >= margin_m) return limits.clearance_m(from, to) >= margin_m;
  return !limits.crosses(from, to) && limits.clearance_m(to) >= margin_m &&
         limits.clearance_m(from, to) >= here_m - kNoise_m;
}

base::EnuPoint stopping_place(const base::Pose& pose, const base::BodyTwist& twist, double part,
                              const FenceParams& p) noexcept {
  const double v = std::abs(twist.linear_mps);
  const double way_m = part * (v * p.react_s + v * v / (2.0 * p.decel_mps2));
  if (way_m < 1e-6) return pose.at;
  const double turn =
      std::clamp(twist.angular_radps / v * way_m, -base::kPi / 2.0, base::kPi / 2.0);
  const double half = 0.5 * turn;
  const double chord_m = std::abs(half) < 1e-6 ? way_m : way_m * std::sin(half) / half;
  const double to = pose.yaw_rad + half + (twist.linear_mps < 0.0 ? base::kPi : 0.0);
  return {pose.at.east_m + chord_m * std::cos(to), pose.at.north_m + chord_m * std::sin(to)};
}

bool may_move(const mission::CompiledFence& limits, const base::Pose& pose,
              const base::BodyTwist& twist, bool by_hand, const FenceParams& p) noexcept {
  if (limits.empty() || twist.linear_mps == 0.0) return true;
  const base::EnuPoint middle = stopping_place(pose, twist, 0.5, p);
  const base::EnuPoint stop = stopping_place(pose, twist, 1.0, p);
  const double margin_m = p.margin_m + pose.horizontal_sigma_m;
  const double near_m =
      std::min(limits.clearance_m(pose.at, middle), limits.clearance_m(middle, stop));
  if (near_m >= margin_m) return true;
  const double here_m = limits.clearance_m(pose.at);
  const bool inwards = limits.clearance_m(stop) > here_m;
  if (here_m > 0.0) return inwards && near_m > 0.0;
  return by_hand && inwards;
}

}  // namespace roverd::robot
