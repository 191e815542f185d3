#include "nav/track/path.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/profile.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;

constexpr double kSame_m = 0.001;
constexpr double kArcStep_m = 0.10;
const double kArcStep_rad = rad_from_deg(8.0);

EnuPoint along(EnuPoint from, double yaw_rad, double by_m) noexcept {
  return {from.east_m + by_m * std::cos(yaw_rad), from.north_m + by_m * std::sin(yaw_rad)};
}

/// The distinct vertices and where each given one went.
struct Distinct {
  std::vector<Vertex> vertices;
  std::vector<std::size_t> of;
};

Distinct distinct(std::span<const Vertex> vertices) {
  Distinct d;
  d.vertices.reserve(vertices.size());
  d.of.reserve(vertices.size());
  for (const Vertex& v : vertices) {
    if (d.vertices.empty() || base::distance_m(d.vertices.back().at, v.at) >= kSame_m) {
      d.vertices.push_back(v);
    } else {
      d.vertices.back().stop |= v.stop;
    }
    d.of.push_back(d.vertices.size() - 1);
  }
  return d;
}

class Builder {
 public:
  Builder(const PathParams& params, Path& path) : params_(params), path_(path) {}

  void add(EnuPoint at, double curvature_1pm, const Vertex& towards) {
    PathPoint p;
    p.at = at;
    p.curvature_1pm = curvature_1pm;
    p.segment_mps = item_mps(towards);
    const double k = std::abs(curvature_1pm);
    if (k > 1e-6) {
      const SpeedLimit bend = bend_limit(k, params_);
      if (bend.mps < p.segment_mps) {
        p.segment_mps = std::max(bend.mps, params_.speed.min_mps);
        p.segment_reason = bend.reason;
      }
    }
    if (!path_.points.empty()) {
      p.s_m = path_.points.back().s_m + base::distance_m(path_.points.back().at, at);
    }
    path_.points.push_back(p);
  }

  /// The arcs at v, from tangent point to tangent point. @return s at which v counts as passed.
  double round(const Vertex& v, const Vertex& next, double yaw_in, const Corner& c) {
    const EnuPoint begin = along(v.at, yaw_in, -c.tangent_m);
    const double turn = c.deflection_rad + c.swing_rad;
    add(begin, turn > 0.0 ? 1.0 / c.radius_m : -1.0 / c.radius_m, v);
    const double middle_m = arc({begin, yaw_in}, turn, c, v, next);
    if (c.swing_rad == 0.0) return middle_m;
    // Passed where the first arc is nearest to the corner, which is not its middle.
    const double nearest_m = path_.points.back().s_m - std::abs(turn) * c.radius_m +
                             std::atan2(c.tangent_m, c.radius_m) * c.radius_m;
    const Place out{path_.points.back().at, yaw_in + turn};
    path_.points.back().curvature_1pm = (turn > 0.0 ? -1.0 : 1.0) / c.radius_m;
    arc(out, -c.swing_rad, c, next, next);
    return nearest_m;
  }

 private:
  struct Place {
    EnuPoint at;
    double yaw_rad;
  };

  /// Points of an arc after its first, which is there already. The limits of `v` hold in its first
  /// half, those of `next` then. @return s of its middle.
  double arc(const Place& from, double turn_rad, const Corner& c, const Vertex& v,
             const Vertex& next) {
    const double side = turn_rad > 0.0 ? 1.0 : -1.0;
    const EnuPoint centre = along(from.at, from.yaw_rad + side * base::kPi / 2.0, c.radius_m);
    const double pieces = std::ceil(std::max(
        {2.0, std::abs(turn_rad) / kArcStep_rad, std::abs(turn_rad) * c.radius_m / kArcStep_m}));
    const int n = 2 * static_cast<int>(std::min(200.0, std::ceil(pieces / 2.0)));
    double middle_m = 0.0;
    for (int i = 1; i <= n; ++i) {
      const double angle = from.yaw_rad - side * base::kPi / 2.0 + turn_rad * i / n;
      const bool last = i == n;
      add(along(centre, angle, c.radius_m), last ? 0.0 : side / c.radius_m, i * 2 < n ? v : next);
      if (i * 2 == n) middle_m = path_.points.back().s_m;
    }
    return middle_m;
  }

  double item_mps(const Vertex& v) const noexcept {
    const SpeedParams& s = params_.speed;
    const double most = v.reverse ? s.reverse_max_mps : s.max_mps;
    return std::min(std::max(v.speed_mps, s.min_mps), most);
  }

  const PathParams& params_;
  Path& path_;
};

}  // namespace

std::string_view to_string(SpeedReason r) noexcept {
  switch (r) {
    case SpeedReason::Item:
      return "item";
    case SpeedReason::Bend:
      return "bend";
    case SpeedReason::Approach:
      return "approach";
    case SpeedReason::Creep:
      return "heading_uncertain";
    case SpeedReason::Heading:
      return "heading_error";
    case SpeedReason::Turn:
      return "turn_rate";
    case SpeedReason::Steer:
      return "steering";
    case SpeedReason::Accel:
      return "acceleration";
    case SpeedReason::Slow:
      return "position_uncertain";
    case SpeedReason::Pivot:
      return "pivot";
    case SpeedReason::Stopping:
      return "stopping";
    case SpeedReason::Standing:
      return "standing";
  }
  return "standing";
}

Path build_path(std::span<const Vertex> given, const PathParams& params) {
  Path path;
  const Distinct d = distinct(given);
  const std::vector<Vertex>& v = d.vertices;
  std::vector<double> passed_m(v.size(), 0.0);
  if (v.size() >= 2) {
    Builder builder(params, path);
    path.points.reserve(v.size() * 2);
    std::size_t leg_first = 0;
    double align = align_rad(v[0], false, params);
    builder.add(v[0].at, 0.0, v[1]);
    for (std::size_t i = 1; i < v.size(); ++i) {
      const bool last = i + 1 == v.size();
      Corner c;
      if (!last) c = corner_at(std::span<const Vertex, 3>(&v[i - 1], 3), params);
      if (c.radius_m > 0.0) {
        passed_m[i] = builder.round(v[i], v[i + 1], direction_rad(v[i - 1].at, v[i].at), c);
        continue;
      }
      builder.add(v[i].at, 0.0, last ? v[i] : v[i + 1]);
      passed_m[i] = path.points.back().s_m;
      if (!last && !c.stop) continue;
      const std::size_t end = path.points.size() - 1;
      path.legs.push_back({leg_first, end, v[i].reverse, path.points[leg_first].s_m,
                           path.points[end].s_m, align,
                           turning_on_the_spot(params.vehicle) ? v[i].yaw_rad : std::nullopt});
      leg_first = end;
      align = align_rad(v[i], c.pivot, params);
    }
    plan_speeds(path, params);
  }
  path.vertex_m.reserve(given.size());
  for (const std::size_t i : d.of) path.vertex_m.push_back(passed_m[i]);
  return path;
}

std::size_t Path::leg_from(double s_m) const noexcept {
  const auto next = std::upper_bound(legs.begin(), legs.end(), s_m + kSame_m,
                                     [](double s, const Leg& leg) { return s < leg.end_m; });
  return static_cast<std::size_t>(next - legs.begin());
}

std::size_t Path::segment_at(const Leg& leg, double s_m, std::size_t near) const noexcept {
  std::size_t i = std::clamp(near, leg.first, leg.last - 1);
  while (i > leg.first && points[i].s_m > s_m) --i;
  while (i + 1 < leg.last && points[i + 1].s_m <= s_m) ++i;
  return i;
}

double Path::yaw_rad(const Leg& leg, double s_m, std::size_t near) const noexcept {
  const std::size_t i = segment_at(leg, s_m, near);
  const PathPoint& a = points[i];
  const PathPoint& b = points[i + 1];
  const double within_m = std::clamp(s_m, a.s_m, b.s_m) - 0.5 * (a.s_m + b.s_m);
  return direction_rad(a.at, b.at) + a.curvature_1pm * within_m;
}

double Path::left_s(double s_m) const noexcept {
  if (points.empty()) return 0.0;
  const auto next = std::upper_bound(points.begin(), points.end(), s_m,
                                     [](double s, const PathPoint& p) { return s < p.s_m; });
  if (next == points.begin()) return points.back().plan_s;
  if (next == points.end()) return 0.0;
  const PathPoint& a = *(next - 1);
  const double part = (s_m - a.s_m) / (next->s_m - a.s_m);
  return points.back().plan_s - a.plan_s - part * (next->plan_s - a.plan_s);
}

EnuPoint Path::at(double s_m) const noexcept {
  if (points.empty()) return {};
  const auto next = std::upper_bound(points.begin(), points.end(), s_m,
                                     [](double s, const PathPoint& p) { return s < p.s_m; });
  if (next == points.begin()) return points.front().at;
  if (next == points.end()) return points.back().at;
  const PathPoint& a = *(next - 1);
  const double part = (s_m - a.s_m) / (next->s_m - a.s_m);
  return {a.at.east_m + part * (next->at.east_m - a.at.east_m),
          a.at.north_m + part * (next->at.north_m - a.at.north_m)};
}

}  // namespace roverd::nav
