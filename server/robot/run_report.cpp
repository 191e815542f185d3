#include "robot/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "nav/behave/route.hpp"

namespace roverd::robot {
namespace {

/// A gap in time longer than this is a pause.
constexpr double kPause_s = 1.0;

void sum_up(RunReport& r, std::span<const ReportPoint> points) {
  double joules = 0.0;
  bool told = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    r.laps = std::max(r.laps, points[i].lap);
    if (i == 0) continue;
    const double dt_s = points[i].t_s - points[i - 1].t_s;
    if (dt_s > kPause_s) continue;
    r.driven_m += base::distance_bearing(points[i - 1].at, points[i].at).distance_m;
    if (points[i].by_itself) r.driving_s += dt_s;
    told = told && points[i].power_w.has_value();
    joules += points[i].power_w.value_or(0.0) * dt_s;
  }
  r.time_s = points.back().t_s - points.front().t_s;
  if (told && points.size() > 1) r.energy_wh = joules / 3600.0;
}

int item_at(const nav::Course& course, double s_m) {
  const auto at = std::lower_bound(course.path.vertex_m.begin(), course.path.vertex_m.end(), s_m);
  const auto i = std::min(static_cast<std::size_t>(at - course.path.vertex_m.begin()),
                          course.nodes.size() - 1);
  return course.nodes[i].item;
}

/// Where what is judged begins.
struct Begin {
  double from_m = 0.0;
  int item = 0;  ///< while this one or one before it is in hand, the robot only comes
};

/// At the first item; or on the way to it, where the run began there: at the item before, which was
/// passed at once, or where a restart had left the mission.
Begin begin_of(const nav::Course& course, int first_item, base::EnuPoint begun) {
  constexpr double kOnIt_m = 0.5;
  constexpr double kLook_m = 0.05;
  const nav::Path& path = course.path;
  std::size_t node = 0;
  while (node + 1 < course.nodes.size() && course.nodes[node].item < first_item) ++node;
  if (node > 0 && course.nodes[node].item >= first_item) {
    Begin on_it;
    double nearest_m = kOnIt_m;
    for (double s_m = path.vertex_m[node - 1]; s_m < path.vertex_m[node]; s_m += kLook_m) {
      const double off_m = base::distance_m(path.at(s_m), begun);
      if (off_m >= nearest_m) continue;
      nearest_m = off_m;
      on_it = {s_m, course.nodes[node - 1].item};
    }
    if (nearest_m < kOnIt_m) return on_it;
  }
  // Two points of one item: the first only leads to the second.
  while (node + 1 < course.nodes.size() && course.nodes[node + 1].item == course.nodes[node].item) {
    ++node;
  }
  return {path.vertex_m[node], course.nodes[node].item};
}

/// The points of one lap in order: first the approach, then what counts.
class Selection {
 public:
  Selection(const nav::Course& course, const base::LocalFrame& frame, int begins_at)
      : frame_(frame), begins_at_(begins_at) {
    for (const nav::RouteNode& n : course.nodes) waypoints_.insert(n.item);
  }

  void take(std::span<const ReportPoint> points) {
    const bool known = std::any_of(points.begin(), points.end(),
                                   [](const ReportPoint& p) { return p.item.has_value(); });
    for (const ReportPoint& p : points) {
      if (p.lap != 1 || over_) continue;
      if (known) judge(p);
      if (counts_) put(p);
      apart_ = apart_ || !p.by_itself;
    }
  }

  std::vector<nav::DrivenPoint> driven;
  std::optional<Approach> approach;
  bool begun = false;  ///< it came to the first item

 private:
  void judge(const ReportPoint& p) {
    counts_ = false;
    if (!begun && p.item && *p.item <= begins_at_) return come(p);
    begun = true;
    if (!p.item || !waypoints_.contains(*p.item)) {
      apart_ = true;
    } else if (*p.item < reached_) {
      over_ = true;  // a jump back: the same way once more
    } else {
      counts_ = true;
      reached_ = *p.item;
    }
  }

  void come(const ReportPoint& p) {
    if (!approach) approach.emplace();
    if (last_ && p.t_s - last_->t_s <= kPause_s) {
      approach->time_s += p.t_s - last_->t_s;
      approach->driven_m += base::distance_bearing(last_->at, p.at).distance_m;
    }
    last_ = p;
  }

  void put(const ReportPoint& p) {
    if (!p.by_itself) return;
    driven.push_back({p.t_s, frame_.to_local(p.at), p.yaw_rad, p.speed_mps, p.yaw_rate_radps,
                      std::exchange(apart_, false)});
  }

  const base::LocalFrame& frame_;
  int begins_at_;
  std::set<int> waypoints_;
  std::optional<ReportPoint> last_;
  int reached_ = 0;
  bool counts_ = true;
  bool apart_ = false;
  bool over_ = false;
};

std::string_view type_by_sight(const mission::Item& item) noexcept {
  if (std::holds_alternative<mission::Row>(item)) return "row";
  if (std::holds_alternative<mission::Wall>(item)) return "wall";
  if (std::holds_alternative<mission::Landmarks>(item)) return "landmarks";
  return {};
}

/// Of |e|, weighed by way as everywhere.
nav::CrossTrack spread_of(std::vector<std::pair<double, double>>& off_weight) {
  nav::CrossTrack out;
  double way_m = 0.0;
  for (const auto& [off_m, weight_m] : off_weight) {
    out.rms_m += off_m * off_m * weight_m;
    out.mean_m += off_m * weight_m;
    out.max_m = std::max(out.max_m, off_m);
    way_m += weight_m;
  }
  if (!(way_m > 0.0)) return {};
  out.rms_m = std::sqrt(out.rms_m / way_m);
  out.mean_m /= way_m;
  std::sort(off_weight.begin(), off_weight.end());
  double behind_m = 0.0;
  for (const auto& [off_m, weight_m] : off_weight) {
    out.p95_m = off_m;
    behind_m += weight_m;
    if (behind_m >= 0.95 * way_m) break;
  }
  return out;
}

/// Items that are driven along what is seen: their line is no part of the route, but how far off it
/// was is in the run's points.
std::vector<SightMeasure> measure_sight(const mission::Plan& plan,
                                        std::span<const ReportPoint> points) {
  std::vector<SightMeasure> out;
  std::vector<std::pair<double, double>> off_weight;
  for (std::size_t k = 0; k < plan.items.size(); ++k) {
    SightMeasure m{static_cast<int>(k) + 1, type_by_sight(plan.items[k]), 0.0, 0.0, {}};
    if (m.type.empty()) continue;
    off_weight.clear();
    bool begun = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ReportPoint& p = points[i];
      if (p.item != m.item || !p.by_itself) continue;
      begun = true;
      const bool follows = i > 0 && points[i - 1].item == m.item && points[i - 1].by_itself &&
                           p.t_s - points[i - 1].t_s <= kPause_s;
      if (!follows) continue;
      const double way_m = base::distance_bearing(points[i - 1].at, p.at).distance_m;
      m.driven_m += way_m;
      if (!p.cross_m) continue;
      m.judged_m += way_m;
      off_weight.emplace_back(std::abs(*p.cross_m), way_m);
    }
    m.cross = spread_of(off_weight);
    if (begun) out.push_back(m);
  }
  return out;
}

}  // namespace

base::Result<RunReport> report_run(
    const mission::Plan& plan, std::span<const ReportPoint> points, int first_item,
    std::span<const std::pair<std::string, base::ParamValue>> parameters) {
  if (points.size() < 2) return base::fail(base::Code::Conflict, "the run has no track");
  Config config;
  for (const auto& [name, value] : parameters) (void)set_parameter(config, name, value);
  const base::LocalFrame frame(1, plan.home ? plan.home->at : points.front().at);
  const auto route = nav::lay_route(plan, frame, config.path());
  if (!route) {
    return base::fail(base::Code::Conflict,
                      "the run's path cannot be laid: " + route.error().detail);
  }
  RunReport r;
  sum_up(r, points);
  r.by_sight = measure_sight(plan, points);
  const nav::Course& course = route->forth;
  if (course.path.legs.empty()) return r;
  const Begin begin = begin_of(course, first_item, frame.to_local(points.front().at));
  Selection counted(course, frame, begin.item);
  counted.take(points);
  r.approach = counted.approach;
  if (counted.driven.size() < 2) return r;
  std::vector<base::EnuPoint> vertices;
  vertices.reserve(course.nodes.size());
  for (const nav::RouteNode& n : course.nodes) vertices.push_back(n.at);
  // Runs of long ago did not keep the item in hand: there the place tells where it began.
  r.measure = nav::measure_run(course.path, vertices, counted.driven, begin.from_m,
                               counted.begun ? nav::Counts::All : nav::Counts::FromNear);
  for (const nav::CornerMeasure& c : r.measure.corners) {
    r.corner_items.push_back(course.nodes[std::min(c.vertex, course.nodes.size() - 1)].item);
  }
  for (const nav::StraightMeasure& s : r.measure.straights) {
    r.straight_items.push_back(item_at(course, s.to_m));
  }
  return r;
}

}  // namespace roverd::robot
