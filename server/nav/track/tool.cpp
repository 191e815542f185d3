#include "nav/track/tool.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/profile.hpp"

namespace roverd::nav {
namespace {

using base::angle_diff_rad;
using base::rad_from_deg;

constexpr double kLedPiece_m = 0.05;
constexpr double kMostPieces = 400'000.0;
const double kTurnsWith_rad = rad_from_deg(60.0);  // a sharper corner is left and begun anew
const double kJoint_rad = rad_from_deg(5.0);
constexpr double kSameWay_rad = 2e-5;  // a straight in one piece: within 1 mm of 50 m
constexpr double kLeastAdvance = 0.1;  // of the point's way; less, and the vehicle would back up
constexpr double kJoint_m = 0.02;
constexpr double kTrailerBend = 1.0;  // radius of the axle's bends by the trailer's length: 45°

/// A place on the way, sampled closely. Yaw in the direction of travel.
struct Place {
  EnuPoint at;
  double yaw_rad = 0.0;
  double s_m = 0.0;         ///< on the point's way
  std::size_t segment = 0;  ///< of the point's way, that leads on from here
};

EnuPoint moved(EnuPoint from, double yaw_rad, double ahead_m, double left_m) noexcept {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {from.east_m + ahead_m * c - left_m * s, from.north_m + ahead_m * s + left_m * c};
}

std::vector<Place> sampled(const Path& path, const Leg& leg, double piece_m) {
  std::vector<Place> all;
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    const PathPoint& a = path.points[i];
    const PathPoint& b = path.points[i + 1];
    const double whole_m = b.s_m - a.s_m;
    const int n = std::max(1, static_cast<int>(std::ceil(whole_m / piece_m)));
    const double chord_rad = direction_rad(a.at, b.at);
    for (int k = 0; k < n; ++k) {
      const double part = double(k) / n;
      const EnuPoint at{a.at.east_m + part * (b.at.east_m - a.at.east_m),
                        a.at.north_m + part * (b.at.north_m - a.at.north_m)};
      all.push_back(
          {at, chord_rad + a.curvature_1pm * (part - 0.5) * whole_m, a.s_m + part * whole_m, i});
    }
  }
  const PathPoint& last = path.points[leg.last];
  all.push_back({last.at, path.yaw_rad(leg, last.s_m, leg.last), last.s_m, leg.last - 1});
  return all;
}

/// The same way in pieces of one length, as a mean over neighbours needs it.
std::vector<Place> evenly(const std::vector<Place>& way, double piece_m) {
  const double begin_m = way.front().s_m;
  const double whole_m = way.back().s_m - begin_m;
  const auto n = static_cast<std::size_t>(std::max(2.0, std::ceil(whole_m / piece_m)));
  std::vector<Place> even;
  even.reserve(n + 1);
  std::size_t i = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double s_m = begin_m + whole_m * double(k) / double(n);
    while (i + 2 < way.size() && way[i + 1].s_m <= s_m) ++i;
    const double piece = std::max(1e-9, way[i + 1].s_m - way[i].s_m);
    const double part = std::clamp((s_m - way[i].s_m) / piece, 0.0, 1.0);
    const EnuPoint by = way[i + 1].at - way[i].at;
    even.push_back({{way[i].at.east_m + part * by.east_m, way[i].at.north_m + part * by.north_m},
                    way[i].yaw_rad + part * angle_diff_rad(way[i].yaw_rad, way[i + 1].yaw_rad),
                    s_m,
                    way[i].segment});
  }
  even.push_back(way.back());
  return even;
}

/// The directions of a way that was moved, from its places.
void point_along(std::vector<Place>& way) noexcept {
  if (way.size() < 2) return;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1;
    const std::size_t b = i + 1 == way.size() ? i : i + 1;
    way[i].yaw_rad = direction_rad(way[a].at, way[b].at);
  }
}

/// Each place becomes the mean of the way over a window about it, straight on beyond its ends.
void average(std::vector<Place>& way, double window_m) {
  const double step_m = (way.back().s_m - way.front().s_m) / double(way.size() - 1);
  const auto half = static_cast<std::size_t>(std::ceil(0.5 * window_m / std::max(step_m, 1e-6)));
  std::vector<EnuPoint> sums{{}};
  sums.reserve(way.size() + 2 * half + 1);
  const auto add = [&sums](EnuPoint p) { sums.push_back(sums.back() + p); };
  // Around the first place, so that the sums stay small.
  const EnuPoint about = way.front().at;
  for (std::size_t i = half; i > 0; --i) {
    add(moved(way.front().at, way.front().yaw_rad, -step_m * double(i), 0.0) - about);
  }
  for (const Place& p : way) add(p.at - about);
  for (std::size_t i = 1; i <= half; ++i) {
    add(moved(way.back().at, way.back().yaw_rad, step_m * double(i), 0.0) - about);
  }
  const double n = double(2 * half + 1);
  for (std::size_t i = 0; i < way.size(); ++i) {
    const EnuPoint sum = sums[i + 2 * half + 1] - sums[i];
    way[i].at = EnuPoint{about.east_m + sum.east_m / n, about.north_m + sum.north_m / n};
  }
  point_along(way);
}

/// One piece of dθ/ds = sin(α − θ)/f with α held: tan(δ/2) falls as e^(−s/f), δ = α − θ.
double drawn_rad(double theta, double alpha, double by_m, double forward_m) noexcept {
  const double delta = angle_diff_rad(theta, alpha);
  const double half = std::clamp(0.5 * delta, -0.499 * base::kPi, 0.499 * base::kPi);
  return alpha - 2.0 * std::atan(std::tan(half) * std::exp(-by_m / forward_m));
}

/// How the vehicle points when a point ahead of it (forward_m > 0) or behind is at each place.
/// @param joint_rad where the leg is joined to its neighbour: at its beginning, or its end.
void turn_with(std::vector<Place>& way, double forward_m, std::optional<double> joint_rad) {
  const auto mean = [](double a, double b) { return a + 0.5 * angle_diff_rad(a, b); };
  std::vector<double> theta(way.size());
  if (forward_m > 0.0) {
    theta.front() = joint_rad.value_or(way.front().yaw_rad);
    for (std::size_t i = 1; i < way.size(); ++i) {
      theta[i] = drawn_rad(theta[i - 1], mean(way[i - 1].yaw_rad, way[i].yaw_rad),
                           way[i].s_m - way[i - 1].s_m, forward_m);
    }
  } else {
    theta.back() = joint_rad.value_or(way.back().yaw_rad);
    for (std::size_t i = way.size() - 1; i > 0; --i) {
      theta[i - 1] = drawn_rad(theta[i], mean(way[i - 1].yaw_rad, way[i].yaw_rad),
                               way[i].s_m - way[i - 1].s_m, -forward_m);
    }
  }
  for (std::size_t i = 0; i < way.size(); ++i) {
    way[i].at = moved(way[i].at, theta[i], -forward_m, 0.0);
    way[i].yaw_rad = theta[i];
  }
}

/// The vehicle's way of one leg of the point's.
std::vector<Place> led_leg(std::vector<Place> way, const ToolParams& tool, bool reverse,
                           std::optional<double> joint_rad, double piece_m) {
  const double travel = reverse ? -1.0 : 1.0;
  if (tool.pulled()) {
    way = evenly(way, piece_m);
    for (Place& p : way) p.at = moved(p.at, p.yaw_rad, 0.0, -tool.left_m);
    average(way, tool.trailer_m);
    for (Place& p : way) p.at = moved(p.at, p.yaw_rad, tool.trailer_m, 0.0);
    point_along(way);
    if (tool.hitch_m > 0.0) turn_with(way, -tool.hitch_m, {});
    return way;
  }
  if (tool.forward_m != 0.0) turn_with(way, travel * tool.forward_m, joint_rad);
  for (Place& p : way) p.at = moved(p.at, p.yaw_rad, 0.0, -travel * tool.left_m);
  return way;
}

/// The first place that the vehicle would have to back up for, or stand still; empty: none.
std::optional<double> first_back_m(const std::vector<Place>& way) noexcept {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Place& a = way[i - 1];
    const Place& b = way[i];
    const double whole_m = b.s_m - a.s_m;
    const double mid_rad = a.yaw_rad + 0.5 * angle_diff_rad(a.yaw_rad, b.yaw_rad);
    const EnuPoint by = b.at - a.at;
    const double ahead_m = by.east_m * std::cos(mid_rad) + by.north_m * std::sin(mid_rad);
    if (whole_m > 1e-9 && ahead_m < kLeastAdvance * whole_m) return b.s_m;
  }
  return std::nullopt;
}

/// Lays the vehicle's path leg by leg.
class Leader {
 public:
  Leader(const Path& given, const PathParams& params) : given_(given), params_(params) {}

  bool lay(double& at_m) {
    const std::size_t legs = given_.legs.size();
    const double piece_m = std::max(kLedPiece_m, given_.length_m() / kMostPieces);
    std::vector<std::vector<Place>> ways(legs);
    const bool from_end = params_.tool.forward_m < 0.0;
    for (std::size_t k = 0; k < legs; ++k) {
      const std::size_t i = from_end ? legs - 1 - k : k;
      const Leg& leg = given_.legs[i];
      if (leg.reverse && params_.tool.pulled()) return refuse(leg.end_m, at_m);
      const auto places = sampled(given_, leg, piece_m);
      const auto joint = joint_rad(ways, i, from_end, places);
      ways[i] = led_leg(places, params_.tool, leg.reverse, joint, piece_m);
      if (joint && first_back_m(ways[i])) {
        ways[i] = led_leg(places, params_.tool, leg.reverse, {}, piece_m);
      }
      if (const auto bad_m = first_back_m(ways[i])) return refuse(*bad_m, at_m);
    }
    for (std::size_t i = 0; i < legs; ++i) add_leg(ways[i], given_.legs[i]);
    for (const double s_m : given_.vertex_m) path_.vertex_m.push_back(led_m(s_m));
    path_.smoothed = given_.smoothed;
    return true;
  }

  Path take() { return std::move(path_); }

 private:
  static bool refuse(double s_m, double& at_m) {
    at_m = s_m;
    return false;
  }

  /// How the vehicle points where this leg meets the one that was laid before it; empty: it may
  /// begin as its own way wants it.
  std::optional<double> joint_rad(const std::vector<std::vector<Place>>& ways, std::size_t leg,
                                  bool from_end, const std::vector<Place>& places) const {
    const std::size_t other = from_end ? leg + 1 : leg - 1;
    if (params_.tool.pulled() || other >= ways.size()) return std::nullopt;
    const bool turns_back = given_.legs[other].reverse != given_.legs[leg].reverse;
    double there = from_end ? ways[other].front().yaw_rad : ways[other].back().yaw_rad;
    if (turns_back) there += base::kPi;
    const double here = from_end ? places.back().yaw_rad : places.front().yaw_rad;
    if (std::abs(angle_diff_rad(here, there)) > kTurnsWith_rad) return std::nullopt;
    return there;
  }

  void add_leg(const std::vector<Place>& way, const Leg& leg) {
    double align_rad = leg.align_rad;
    if (path_.points.empty()) {
      add_point(way.front(), 0.0);
    } else if (!params_.vehicle.steered() &&
               base::distance_m(path_.points.back().at, way.front().at) > kJoint_m) {
      add_joint(way.front());
      align_rad = kJoint_rad;
    }
    const std::size_t first = path_.points.size() - 1;
    path_.points.back().segment_mps = given_.points[way.front().segment].segment_mps;
    path_.points.back().segment_reason = given_.points[way.front().segment].segment_reason;
    std::size_t kept = 0;
    double s_m = path_.points.back().s_m;
    led_.push_back({way.front().s_m, s_m});
    EnuPoint from = path_.points.back().at;
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Place& p = way[i];
      const bool last = i + 1 == way.size();
      const bool straight =
          std::abs(angle_diff_rad(way[kept].yaw_rad, p.yaw_rad)) < kSameWay_rad &&
          (last || std::abs(angle_diff_rad(p.yaw_rad, way[i + 1].yaw_rad)) < kSameWay_rad);
      if (!last && straight && way[i].segment == way[kept].segment) continue;
      s_m += base::distance_m(from, p.at);
      from = p.at;
      bend_between(way[kept], p, s_m);
      add_point(p, s_m);
      kept = i;
      led_.push_back({p.s_m, s_m});
    }
    const std::size_t end = path_.points.size() - 1;
    path_.legs.push_back({first, end, leg.reverse, path_.points[first].s_m, path_.points[end].s_m,
                          align_rad, leg.end_yaw_rad});
  }

  /// Curvature and speed of the segment from the last point to this place.
  void bend_between(const Place& from, const Place& to, double s_m) {
    PathPoint& p = path_.points.back();
    const double ds = s_m - p.s_m;
    p.curvature_1pm = ds > 1e-6 ? angle_diff_rad(from.yaw_rad, to.yaw_rad) / ds : 0.0;
    if (std::abs(p.curvature_1pm) < 1e-5) p.curvature_1pm = 0.0;
    // The vehicle is on an outer way, or an inner one: the item's speed is its own.
    p.segment_mps = given_.points[from.segment].segment_mps;
    p.segment_reason = given_.points[from.segment].segment_reason;
    if (p.curvature_1pm == 0.0) return;
    const SpeedLimit bend = bend_limit(std::abs(p.curvature_1pm), params_);
    if (bend.mps >= p.segment_mps) return;
    p.segment_mps = std::max(bend.mps, params_.speed.min_mps);
    p.segment_reason = bend.reason;
  }

  void add_point(const Place& place, double s_m) {
    PathPoint p;
    p.at = place.at;
    p.s_m = s_m;
    p.segment_mps = given_.points[place.segment].segment_mps;
    p.segment_reason = given_.points[place.segment].segment_reason;
    path_.points.push_back(p);
  }

  /// Straight to where the next leg begins, with a turn before and behind.
  void add_joint(const Place& to) {
    PathPoint& from = path_.points.back();
    from.segment_mps = std::min(params_.speed.creep_mps, params_.speed.max_mps);
    from.segment_reason = SpeedReason::Item;
    from.curvature_1pm = 0.0;
    const double s_m = from.s_m + base::distance_m(from.at, to.at);
    const double start_m = from.s_m;
    add_point(to, s_m);
    const std::size_t end = path_.points.size() - 1;
    path_.legs.push_back({end - 1, end, false, start_m, s_m, kJoint_rad, {}});
  }

  /// A stop belongs to the leg that ends there.
  double led_m(double s_m) const noexcept {
    if (led_.empty()) return 0.0;
    const auto next = std::lower_bound(led_.begin(), led_.end(), s_m - 1e-9,
                                       [](const auto& pair, double s) { return pair.first < s; });
    if (next == led_.begin()) return next->second;
    if (next == led_.end()) return led_.back().second;
    const auto before = next - 1;
    const double whole_m = next->first - before->first;
    const double part =
        whole_m > 1e-9 ? std::clamp((s_m - before->first) / whole_m, 0.0, 1.0) : 0.0;
    return before->second + part * (next->second - before->second);
  }

  const Path& given_;
  const PathParams& params_;
  Path path_;
  std::vector<std::pair<double, double>> led_;  ///< s of the point, s of the vehicle; rising
};

}  // namespace

base::Result<Path> led_way(const Path& point_way, const PathParams& params, double& at_m) {
  if (!params.tool.fitted() || point_way.legs.empty()) return point_way;
  Leader leader(point_way, params);
  if (!leader.lay(at_m)) {
    const auto leg = std::ranges::find(point_way.legs, at_m, &Leg::end_m);
    const bool pushed = params.tool.pulled() && leg != point_way.legs.end() && leg->reverse;
    return base::fail(base::Code::Invalid,
                      pushed ? "cannot be reached backwards: a trailer is pulled "
                               "(nav.tool.trailer_m)"
                             : "cannot be reached: a bend before it is too narrow for what follows "
                               "the way (nav.tool)");
  }
  Path path = leader.take();
  limit_steering(path, params);
  plan_speeds(path, params);
  return path;
}

VehicleParams pulling(const VehicleParams& vehicle, const ToolParams& tool) noexcept {
  if (!tool.pulled() || vehicle.steered()) return vehicle;
  VehicleParams car = vehicle;
  car.kinematics = "ackermann";
  // Bends of about a trailer's length are the narrowest that it pulls through.
  car.wheelbase_m = std::max(0.5, tool.trailer_m);
  car.max_steering_deg = 45.0;
  car.max_steering_rate_dps = 60.0;
  return car;
}

PathParams point_params(const PathParams& params) {
  PathParams p = params;
  const ToolParams& t = params.tool;
  if (!t.fitted() || !params.vehicle.steered()) return p;
  const double least_m = min_radius_m(params.vehicle);
  const double wanted_m =
      t.pulled() ? std::max(kTrailerBend * t.trailer_m + std::abs(t.left_m),
                            std::sqrt(std::max(0.0, least_m * least_m + t.hitch_m * t.hitch_m -
                                                        t.trailer_m * t.trailer_m)) +
                                std::abs(t.left_m))
                 : std::hypot(least_m + std::abs(t.left_m), t.forward_m);
  const double radius_m = std::max(least_m, wanted_m);
  p.vehicle.max_steering_deg =
      base::deg_from_rad(std::atan(1.1 * p.vehicle.wheelbase_m / radius_m));
  return p;
}

}  // namespace roverd::nav
