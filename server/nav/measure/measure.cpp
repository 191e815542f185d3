#include "nav/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

constexpr double kNearStart_m = 0.5;
constexpr double kBack_m = 0.3;       // so far the matched place may look back
constexpr double kNearEnd_m = 1.5;    // of a leg, before the next one may begin
constexpr double kMoving_mps = 0.02;  // slower, the sign of a speed says nothing
constexpr double kCornerReach_m = 2.5;
constexpr double kTrim_m = 1.0;
constexpr double kShortest_m = 3.0;
constexpr double kMeanOver_s = 6.0;
constexpr double kGrid_s = 0.2;
const double kCorner_rad = base::rad_from_deg(10.0);

/// A driven point seen from one leg.
struct Seen {
  double s_m = 0.0;
  double off_m = 1e300;
  double lateral_m = 0.0;
  double heading_rad = 0.0;
};

Seen look(const Path& path, std::size_t leg_index, const DrivenPoint& p, double from_m,
          double to_m) {
  const Leg& leg = path.legs[leg_index];
  const double low_m = std::clamp(from_m, leg.start_m, leg.end_m);
  const double high_m = std::clamp(to_m, low_m, leg.end_m);
  const auto first =
      std::upper_bound(path.points.begin() + static_cast<std::ptrdiff_t>(leg.first),
                       path.points.begin() + static_cast<std::ptrdiff_t>(leg.last), low_m,
                       [](double s, const PathPoint& point) { return s < point.s_m; });
  auto i = static_cast<std::size_t>(first - path.points.begin());
  i = i > leg.first ? i - 1 : i;
  Seen best;
  for (; i < leg.last && path.points[i].s_m <= high_m; ++i) {
    const PathPoint& a = path.points[i];
    const PathPoint& b = path.points[i + 1];
    const EnuPoint d = b.at - a.at;
    const EnuPoint r = p.at - a.at;
    const double length = b.s_m - a.s_m;
    const double c = d.east_m / length;
    const double s = d.north_m / length;
    const double along = std::clamp(c * r.east_m + s * r.north_m, std::max(0.0, low_m - a.s_m),
                                    std::max(0.0, std::min(length, high_m - a.s_m)));
    const double off_m = std::hypot(r.east_m - along * c, r.north_m - along * s);
    if (off_m >= best.off_m) continue;
    const double tangent = std::atan2(s, c) + (leg.reverse ? base::kPi : 0.0);
    best = {a.s_m + along, off_m, c * r.north_m - s * r.east_m,
            base::angle_diff_rad(tangent, p.yaw_rad)};
  }
  return best;
}

/// Does the robot drive or point as the next leg asks for, more than as this one does?
bool goes_on(const Path& path, std::size_t leg, const DrivenPoint& p, const Seen& now,
             const Seen& next) {
  const bool reverse = path.legs[leg + 1].reverse;
  if (reverse != path.legs[leg].reverse) {
    return std::abs(p.speed_mps) > kMoving_mps && (p.speed_mps < 0.0) == reverse;
  }
  return std::abs(next.heading_rad) < std::abs(now.heading_rad);
}

class Matcher {
 public:
  Matcher(const Path& path, double from_m)
      : path_(path), s_m_(std::clamp(from_m, 0.0, path.length_m())) {
    leg_ = std::min(path.leg_from(s_m_), path.legs.size() - 1);
  }

  Matched match(const DrivenPoint& p, double moved_m) {
    const double reach_m = 1.0 + 2.0 * moved_m;
    Seen seen = look(path_, leg_, p, s_m_ - kBack_m, s_m_ + reach_m);
    Seen beside;  // on the other side of the stop that is near
    const double end_m = path_.legs[leg_].end_m;
    if (leg_ + 1 < path_.legs.size() && std::max(s_m_, seen.s_m) >= end_m - kNearEnd_m) {
      beside = look(path_, leg_ + 1, p, end_m, end_m + reach_m);
      if (beside.s_m > end_m + 0.02 && goes_on(path_, leg_, p, seen, beside)) {
        std::swap(seen, beside);
        ++leg_;
      }
    } else if (leg_ > 0 && s_m_ <= path_.legs[leg_].start_m + kNearEnd_m) {
      beside = look(path_, leg_ - 1, p, s_m_ - 2.0 * kNearEnd_m, s_m_);
    }
    s_m_ = std::max(s_m_, seen.s_m);
    const Seen& nearest = beside.off_m < seen.off_m ? beside : seen;
    return {p.t_s,
            s_m_,
            std::copysign(nearest.off_m, nearest.lateral_m),
            seen.lateral_m,
            seen.heading_rad,
            moved_m,
            leg_};
  }

 private:
  const Path& path_;
  double s_m_;
  std::size_t leg_ = 0;
};

/// The driven point, seen from where it thought to be; near a stop, from the nearer of both legs.
void see_from(const Path& path, Matched& m, const DrivenPoint& driven, const DrivenPoint& thought) {
  const double reach_m = kNearEnd_m + base::distance_m(driven.at, thought.at);
  const std::size_t last = std::min(m.leg + 1, path.legs.size() - 1);
  Seen nearest;
  for (std::size_t leg = m.leg > 0 ? m.leg - 1 : 0; leg <= last; ++leg) {
    const bool meets =
        path.legs[leg].start_m <= m.s_m + reach_m && path.legs[leg].end_m >= m.s_m - reach_m;
    if (!meets) continue;
    const Seen seen = look(path, leg, driven, m.s_m - reach_m, m.s_m + reach_m);
    if (leg == m.leg) {
      m.lateral_m = seen.lateral_m;
      m.heading_rad = seen.heading_rad;
    }
    if (seen.off_m < nearest.off_m) nearest = seen;
  }
  m.cross_m = std::copysign(nearest.off_m, nearest.lateral_m);
}

std::size_t first_counted(const Path& path, std::span<const DrivenPoint> driven, double from_m) {
  const EnuPoint start = path.at(from_m);
  for (std::size_t i = 0; i < driven.size(); ++i) {
    if (base::distance_m(driven[i].at, start) < kNearStart_m) return i;
  }
  return 0;
}

/// The smallest value below which this share of the weight lies.
double percentile(std::vector<std::pair<double, double>> weighted, double share) {
  if (weighted.empty()) return 0.0;
  std::sort(weighted.begin(), weighted.end());
  double total = 0.0;
  for (const auto& [value, weight] : weighted) total += weight;
  double sum = 0.0;
  for (const auto& [value, weight] : weighted) {
    sum += weight;
    if (sum >= share * total) return value;
  }
  return weighted.back().first;
}

CrossTrack cross_track(std::span<const Matched> all) {
  CrossTrack c;
  double weight = 0.0;
  std::vector<std::pair<double, double>> errors;
  errors.reserve(all.size());
  for (const Matched& m : all) {
    const double e = std::abs(m.cross_m);
    c.rms_m += m.weight_m * e * e;
    c.mean_m += m.weight_m * e;
    c.max_m = std::max(c.max_m, e);
    weight += m.weight_m;
    errors.emplace_back(e, m.weight_m);
  }
  if (weight <= 0.0) return {0.0, 0.0, 0.0, c.max_m};
  c.rms_m = std::sqrt(c.rms_m / weight);
  c.mean_m /= weight;
  c.p95_m = percentile(std::move(errors), 0.95);
  return c;
}

double yaw_between(EnuPoint a, EnuPoint b) {
  return std::atan2(b.north_m - a.north_m, b.east_m - a.east_m);
}

/// Indices of `all` whose place lies in [from, to]; places only grow.
std::pair<std::size_t, std::size_t> range(std::span<const Matched> all, double from_m,
                                          double to_m) {
  const auto low = std::lower_bound(all.begin(), all.end(), from_m,
                                    [](const Matched& m, double s_m) { return m.s_m < s_m; });
  const auto high = std::upper_bound(low, all.end(), to_m,
                                     [](double s_m, const Matched& m) { return s_m < m.s_m; });
  return {static_cast<std::size_t>(low - all.begin()),
          static_cast<std::size_t>(high - all.begin())};
}

struct Drive {
  std::span<const Matched> all;
  std::span<const DrivenPoint> driven;
  double from_m = 0.0;
};

void corners(RunMeasure& run, const Path& path, std::span<const EnuPoint> vertices,
             const Drive& drive) {
  const auto& [all, driven, from_m] = drive;
  const std::size_t n = std::min(vertices.size(), path.vertex_m.size());
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (path.vertex_m[i] <= from_m || base::distance_m(vertices[i - 1], vertices[i]) < 0.001 ||
        base::distance_m(vertices[i], vertices[i + 1]) < 0.001) {
      continue;
    }
    CornerMeasure c;
    c.vertex = i;
    c.s_m = path.vertex_m[i];
    c.deflection_rad = base::angle_diff_rad(yaw_between(vertices[i - 1], vertices[i]),
                                            yaw_between(vertices[i], vertices[i + 1]));
    if (std::abs(c.deflection_rad) < kCorner_rad) continue;
    const auto [first, last] = range(all, c.s_m - kCornerReach_m, c.s_m + kCornerReach_m);
    if (first == last) continue;
    c.distance_m = 1e300;
    for (std::size_t k = first; k < last; ++k) {
      const double inwards = c.deflection_rad > 0.0 ? all[k].cross_m : -all[k].cross_m;
      c.inside_m = std::max(c.inside_m, inwards);
      c.outside_m = std::max(c.outside_m, -inwards);
      c.distance_m = std::min(c.distance_m, base::distance_m(driven[k].at, vertices[i]));
    }
    run.corner_mean_m += c.distance_m;
    run.corner_max_m = std::max(run.corner_max_m, c.distance_m);
    run.cut_max_m = std::max(run.cut_max_m, c.inside_m);
    run.overshoot_max_m = std::max(run.overshoot_max_m, c.outside_m);
    run.corners.push_back(c);
  }
  if (!run.corners.empty()) run.corner_mean_m /= static_cast<double>(run.corners.size());
}

double slalom_m(std::span<const Matched> part) {
  std::vector<std::pair<double, double>> rest;
  rest.reserve(part.size());
  std::size_t first = 0;
  std::size_t last = 0;
  double sum = 0.0;
  for (const Matched& m : part) {
    while (last < part.size() && part[last].t_s <= m.t_s + kMeanOver_s / 2.0) {
      sum += part[last++].cross_m;
    }
    while (part[first].t_s < m.t_s - kMeanOver_s / 2.0) sum -= part[first++].cross_m;
    rest.emplace_back(m.cross_m - sum / static_cast<double>(last - first), m.weight_m);
  }
  return percentile(rest, 0.975) - percentile(rest, 0.025);
}

void straight(RunMeasure& run, std::span<const Matched> all, double from_m, double to_m) {
  if (to_m - from_m < kShortest_m) return;
  const auto [first, last] = range(all, from_m + kTrim_m, to_m - kTrim_m);
  if (last - first < 4) return;
  const StraightMeasure s{from_m, to_m, slalom_m(all.subspan(first, last - first))};
  run.slalom_mean_m += s.slalom_m;
  run.slalom_max_m = std::max(run.slalom_max_m, s.slalom_m);
  run.straights.push_back(s);
}

/// Straights end at a bend, at a vertex that turns, and at the end of a leg.
void straights(RunMeasure& run, const Path& path, std::span<const Matched> all) {
  for (const Leg& leg : path.legs) {
    double from_m = leg.start_m;
    double yaw = 0.0;
    for (std::size_t i = leg.first; i < leg.last; ++i) {
      const double yaw_here = yaw_between(path.points[i].at, path.points[i + 1].at);
      const bool bend = std::abs(path.points[i].curvature_1pm) > 1e-6;
      const bool turns =
          i > leg.first && std::abs(base::angle_diff_rad(yaw, yaw_here)) > base::rad_from_deg(1.0);
      if (bend || turns) {
        straight(run, all, from_m, path.points[i].s_m);
        from_m = path.points[bend ? i + 1 : i].s_m;
      }
      yaw = yaw_here;
    }
    straight(run, all, from_m, leg.end_m);
  }
  if (!run.straights.empty()) run.slalom_mean_m /= static_cast<double>(run.straights.size());
}

void smoothness(RunMeasure& run, std::span<const Matched> all,
                std::span<const DrivenPoint> driven) {
  double weight = 0.0;
  for (const Matched& m : all) {
    run.heading_rms_rad += m.weight_m * m.heading_rad * m.heading_rad;
    weight += m.weight_m;
  }
  run.heading_rms_rad = weight > 0.0 ? std::sqrt(run.heading_rms_rad / weight) : 0.0;
  std::vector<std::size_t> grid;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    if (grid.empty() || driven[i].t_s >= driven[grid.back()].t_s + kGrid_s - 1e-6)
      grid.push_back(i);
  }
  double turns = 0.0;
  double jerks = 0.0;
  double accel_before = 0.0;
  for (std::size_t k = 1; k < grid.size(); ++k) {
    const DrivenPoint& a = driven[grid[k - 1]];
    const DrivenPoint& b = driven[grid[k]];
    const double dt_s = b.t_s - a.t_s;
    const double turn = (b.yaw_rate_radps - a.yaw_rate_radps) / dt_s;
    const double accel = (b.speed_mps - a.speed_mps) / dt_s;
    turns += turn * turn;
    if (k > 1) jerks += (accel - accel_before) * (accel - accel_before) / (dt_s * dt_s);
    accel_before = accel;
  }
  if (grid.size() > 1)
    run.yaw_accel_rms_radps2 = std::sqrt(turns / static_cast<double>(grid.size() - 1));
  if (grid.size() > 2) run.jerk_rms_mps3 = std::sqrt(jerks / static_cast<double>(grid.size() - 2));
}

}  // namespace

std::vector<Matched> match_run(const Path& path, std::span<const DrivenPoint> driven, double from_m,
                               Counts counts, Thought thought) {
  std::vector<Matched> out;
  if (path.legs.empty() || driven.empty()) return out;
  const auto places = thought.size() == driven.size() ? thought : driven;
  const std::size_t first = counts == Counts::All ? 0 : first_counted(path, places, from_m);
  out.reserve(driven.size() - first);
  Matcher matcher(path, from_m);
  for (std::size_t i = first; i < driven.size(); ++i) {
    const double moved_m = i > first ? base::distance_m(places[i - 1].at, places[i].at) : 0.0;
    out.push_back(matcher.match(places[i], moved_m));
    if (&places[i] != &driven[i]) see_from(path, out.back(), driven[i], places[i]);
    if (driven[i].apart) out.back().weight_m = 0.0;
  }
  return out;
}

RunMeasure measure_run(const Path& path, std::span<const EnuPoint> vertices,
                       std::span<const DrivenPoint> driven, double from_m, Counts counts,
                       Thought thought) {
  RunMeasure run;
  if (driven.empty()) return run;
  run.time_s = driven.back().t_s - driven.front().t_s;
  for (std::size_t i = 1; i < driven.size(); ++i) {
    if (!driven[i].apart) run.driven_m += base::distance_m(driven[i - 1].at, driven[i].at);
  }
  const std::vector<Matched> all = match_run(path, driven, from_m, counts, thought);
  const auto counted = driven.last(all.size());
  smoothness(run, all, counted);
  if (all.empty()) return run;
  run.matched_m = all.back().s_m;
  run.end_m = base::distance_m(driven.back().at, path.points.back().at);
  run.cross = cross_track(all);
  corners(run, path, vertices, {all, counted, from_m});
  straights(run, path, all);
  return run;
}

}  // namespace roverd::nav
