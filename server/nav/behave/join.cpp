#include "nav/behave/join.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kJoinLook_m = 0.05;
constexpr double kOtherLane_m = 0.3;  // farther again by so much: what comes then is another lane
constexpr double kToStop_m = 0.3;     // nearer to a place to stop at it would not come to it
constexpr double kRoomToBend = 1.3;   // of the least radius, for the wheels' slowness
constexpr double kToSettle = 2.0;     // metres ahead that take it one metre nearer to its way
const double kAlong_rad = base::rad_from_deg(25.0);
const double kAhead_rad = base::rad_from_deg(90.0);

/// Driven through without anything happening there.
bool plain(const Course& course, std::size_t i) noexcept {
  return course.steps[i].kind == StepKind::Go && !(course.steps[i].seconds > 0.0) &&
         i + 1 < course.steps.size() && course.steps[i + 1].kind == StepKind::Go;
}

/// What is done before the first waypoint leaves the robot where it is.
std::size_t first_go(const Course& course, std::size_t step) noexcept {
  while (step < course.steps.size() &&
         (course.steps[step].kind == StepKind::Act || course.steps[step].kind == StepKind::Wait)) {
    ++step;
  }
  return step;
}

struct Nearest {
  double s_m = 0.0;
  double off_m = 0.0;
};

Nearest nearest(const Path& path, EnuPoint here, double from_m, double to_m) noexcept {
  Nearest best{from_m, base::distance_m(here, path.at(from_m))};
  for (double s_m = from_m; s_m < to_m;) {
    s_m = std::min(to_m, s_m + kJoinLook_m);
    const double off_m = base::distance_m(here, path.at(s_m));
    if (off_m > best.off_m + kOtherLane_m) break;
    if (off_m < best.off_m) best = {s_m, off_m};
  }
  return best;
}

bool points_along(const Path& path, double s_m, const Stand& stand, double within_rad) noexcept {
  if (!stand.yaw_rad) return true;
  const Leg& leg = path.legs[std::min(path.leg_from(s_m), path.legs.size() - 1)];
  const double way_rad = path.yaw_rad(leg, s_m, leg.first) + (leg.reverse ? base::kPi : 0.0);
  return std::abs(base::angle_diff_rad(*stand.yaw_rad, way_rad)) <= within_rad;
}

/// A steered vehicle comes to the way's place by one bend ahead, of the radius d / (2·sin β), and
/// then points along it.
bool on_one_arc(const Stand& stand, const Path& path, double s_m, double least_radius_m) noexcept {
  if (!stand.yaw_rad) return false;
  const EnuPoint to = path.at(s_m);
  const double off_m = base::distance_m(stand.at, to);
  const double bearing = base::angle_diff_rad(*stand.yaw_rad, direction_rad(stand.at, to));
  if (std::abs(bearing) > kAhead_rad / 2.0 || off_m < kOtherLane_m) return false;
  Stand arrives = stand;
  arrives.yaw_rad = base::wrap_rad(*stand.yaw_rad + 2.0 * bearing);
  if (!points_along(path, s_m, arrives, kAlong_rad)) return false;
  return off_m > 2.0 * kRoomToBend * least_radius_m * std::sin(std::abs(bearing));
}

}  // namespace

double arrival_radius_m(const RouteNode* node, double sigma_m, const BehaveParams& p) noexcept {
  const double radius_m = node != nullptr ? node->radius_m : 0.0;
  return std::max({p.missed_m, radius_m, p.arrive_sigmas * sigma_m});
}

std::optional<Joining> join_way(const Route& route, std::size_t step, const Stand& stand,
                                const PathParams& path_params, const BehaveParams& p) noexcept {
  const Course& course = route.forth;
  const Path& path = course.path;
  const std::size_t first = first_go(course, step);
  if (p.join_m <= 0.0 || path.legs.empty() || first >= course.steps.size()) return std::nullopt;
  if (!plain(course, first)) return std::nullopt;

  const bool steered = path_params.vehicle.steered();
  const double known_m = p.arrive_sigmas * stand.sigma_m;
  const double least_m = steered ? 2.0 * min_radius_m(path_params.vehicle) : 0.0;
  const double reach_m = std::max({p.join_m, known_m, least_m});
  const double from_m = path.vertex_m[course.steps[first].node];
  double to_m = std::min(from_m + reach_m, path.length_m());
  std::size_t stop = first;
  while (plain(course, stop)) ++stop;
  const double stop_m = path.vertex_m[course.steps[stop].node];
  to_m = std::min(to_m, stop_m - kToStop_m);
  if (to_m <= from_m) return std::nullopt;

  const Nearest at = nearest(path, stand.at, from_m, to_m);
  const double beside_m =
      std::min({reach_m, kBesideOfLost * p.lost_m, route.corridor_m.value_or(p.lost_m)});
  // Nearest at the end of what was looked at: it stands farther on, at another part of the way.
  if (at.off_m > beside_m || (at.s_m >= to_m && !steered)) return std::nullopt;
  const RouteNode& node = course.nodes[course.steps[first].node];
  const double there_m = std::max(node.radius_m, known_m);
  const bool there = base::distance_m(stand.at, node.at) <= there_m;
  // From before item 1 the way leads to it first, unless a steered vehicle is too near to aim at
  // it.
  const bool aims = !steered || on_one_arc(stand, path, from_m, min_radius_m(path_params.vehicle));
  if (at.s_m <= from_m && !there && aims) return std::nullopt;
  if (!there && !steered && !points_along(path, at.s_m, stand, kAhead_rad)) return std::nullopt;

  Joining join{first, at.s_m, at.s_m - from_m, 0};
  for (; join.step < stop; ++join.step) {
    const RouteStep& behind = course.steps[join.step];
    if (path.vertex_m[behind.node] > at.s_m) break;
    const RouteNode& left = course.nodes[behind.node];
    const bool counts =
        base::distance_m(stand.at, left.at) <= arrival_radius_m(&left, stand.sigma_m, p);
    if (!counts && !behind.silent) ++join.left_out;
  }
  const RouteNode& ahead = course.nodes[course.steps[join.step].node];
  const double beyond_m = at.off_m - arrival_radius_m(&ahead, stand.sigma_m, p);
  const double left_m = path.vertex_m[course.steps[join.step].node] - at.s_m;
  if (!steered && left_m < kToSettle * beyond_m) return std::nullopt;  // it would miss that one
  return join;
}

}  // namespace roverd::nav
