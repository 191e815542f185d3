#include "nav/track/path.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "nav/track/ease.hpp"
#include "nav/track/profile.hpp"
#include "nav/track/smooth.hpp"

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
      d.vertices.back().dense &= v.dense;
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

  /// The same of curvature that comes and goes. @return s where it is nearest to v.
  double ease(const Vertex& v, const Vertex& next, double yaw_in, const Corner& c) {
    const double side = c.deflection_rad > 0.0 ? 1.0 : -1.0;
    const double turn = std::abs(c.deflection_rad) + std::abs(c.swing_rad);
    const EasedBend bend(along(v.at, yaw_in, -c.tangent_m), yaw_in,
                         {{{turn * c.radius_m, side / c.radius_m},
                           {std::abs(c.swing_rad) * c.radius_m, -side / c.radius_m}}},
                         c.ease_m);
    const double n = std::clamp(std::ceil(bend.length_m() / kArcStep_m), 8.0, 400.0);
    double nearest_m = 1e300;
    double passed_m = 0.0;
    for (int i = 0; i <= static_cast<int>(n); ++i) {
      const double step_m = bend.length_m() / n;
      const EnuPoint at = bend.place(i * step_m).at;
      const bool last = i == static_cast<int>(n);
      const double away_m = base::distance_m(at, v.at);
      add(at, last ? 0.0 : bend.place((i + 0.5) * step_m).curvature_1pm,
          away_m < nearest_m ? v : next);
      if (away_m < nearest_m) passed_m = path_.points.back().s_m;
      nearest_m = std::min(nearest_m, away_m);
    }
    return passed_m;
  }

  /// Points between two vertices on a circle; both are added by others. Chords leave it by 1 mm.
  void bend(EnuPoint from, const Vertex& to) {
    const double radius_m = 1.0 / std::abs(to.curvature_1pm);
    const double side = to.curvature_1pm > 0.0 ? 1.0 : -1.0;
    const double chord_m = base::distance_m(from, to.at);
    const double turn_rad = 2.0 * std::asin(std::min(1.0, 0.5 * chord_m / radius_m));
    const double yaw_in = direction_rad(from, to.at) - side * 0.5 * turn_rad;
    const EnuPoint centre = along(from, yaw_in + side * base::kPi / 2.0, radius_m);
    const double step_m = std::max(kArcStep_m, std::sqrt(8.0 * radius_m * kSame_m));
    const int n = static_cast<int>(
        std::ceil(std::max(turn_rad / kArcStep_rad, turn_rad * radius_m / step_m)));
    for (int i = 1; i < n; ++i) {
      const double angle = yaw_in - side * base::kPi / 2.0 + side * turn_rad * i / n;
      add(along(centre, angle, radius_m), to.curvature_1pm, to);
    }
  }

  /// The arcs at v, from tangent point to tangent point. @return s at which v counts as passed.
  double round(const Vertex& v, const Vertex& next, double yaw_in, const Corner& c) {
    if (c.ease_m > 0.0) return ease(v, next, yaw_in, c);
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

/// Points and legs. @return by point of the way, the arc length at which it is passed.
std::vector<double> lay(const std::vector<WayPoint>& way, const PathParams& params, Path& path) {
  std::vector<double> passed_m(way.size(), 0.0);
  Builder builder(params, path);
  path.points.reserve(way.size() * 2);
  std::size_t leg_first = 0;
  double align = align_rad(way[0].vertex, false, params);
  builder.add(way[0].vertex.at, way[0].curvature_1pm, way[1].vertex);
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vertex& v = way[i].vertex;
    if (v.curvature_1pm != 0.0) builder.bend(path.points.back().at, v);
    const bool last = i + 1 == way.size();
    Corner c;
    if (!last && !way[i].on_curve) {
      const Vertex three[] = {way[i - 1].vertex, v, way[i + 1].vertex};
      c = corner_at(three, params);
    }
    if (c.radius_m > 0.0) {
      const double yaw_in = direction_rad(way[i - 1].vertex.at, v.at);
      passed_m[i] = builder.round(v, way[i + 1].vertex, yaw_in, c);
      continue;
    }
    builder.add(v.at, way[i].curvature_1pm, last ? v : way[i + 1].vertex);
    passed_m[i] = path.points.back().s_m;
    if (!last && !c.stop) continue;
    const std::size_t end = path.points.size() - 1;
    path.legs.push_back({leg_first, end, v.reverse, path.points[leg_first].s_m,
                         path.points[end].s_m, align,
                         turning_on_the_spot(params.vehicle) ? v.yaw_rad : std::nullopt});
    leg_first = end;
    align = align_rad(v, c.pivot, params);
  }
  return passed_m;
}

/// @param of where each given vertex went.
std::vector<SmoothStretch> stretches_of(std::vector<SmoothStretch> stretches,
                                        const std::vector<std::size_t>& of) {
  const auto index = [&of](auto place) { return static_cast<std::size_t>(place - of.begin()); };
  for (SmoothStretch& s : stretches) {
    s.first = index(std::lower_bound(of.begin(), of.end(), s.first));
    s.last = index(std::upper_bound(of.begin(), of.end(), s.last)) - 1;
  }
  return stretches;
}

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
    case SpeedReason::Slope:
      return "slope";
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
  std::vector<double> passed_m(d.vertices.size(), 0.0);
  if (d.vertices.size() >= 2) {
    SmoothedWay way = smoothed_way(d.vertices, params);
    for (std::size_t i = 0; i < way.points.size(); ++i) {
      WayPoint& p = way.points[i];
      if (p.vertex.tangent && !p.vertex.stop) p.on_curve = true;
      if (i + 1 == way.points.size() || way.points[i + 1].vertex.curvature_1pm == 0.0) continue;
      p.curvature_1pm = way.points[i + 1].vertex.curvature_1pm;
    }
    const std::vector<double> at_m = lay(way.points, params, path);
    for (std::size_t i = 0; i < passed_m.size(); ++i) {
      const auto [point, part] = way.passed[i];
      const double next_m = at_m[std::min(point + 1, at_m.size() - 1)];
      passed_m[i] = at_m[point] + part * (next_m - at_m[point]);
      // No leg is left to drive on between such a one and the stop.
      for (const std::size_t leg : {path.leg_from(passed_m[i]), path.leg_from(passed_m[i]) - 1}) {
        if (leg >= path.legs.size()) continue;
        const double left_m = path.legs[leg].end_m - passed_m[i];
        if (left_m > 0.0 && left_m < 2.0 * kSame_m) passed_m[i] = path.legs[leg].end_m;
      }
    }
    path.smoothed = stretches_of(way.stretches, d.of);
    limit_steering(path, params);
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
