#include "robot/run_report.hpp"

#include <algorithm>

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
  const nav::Course& course = route->forth;
  if (course.path.legs.empty()) return r;
  std::vector<nav::DrivenPoint> driven;
  driven.reserve(points.size());
  for (const ReportPoint& p : points) {
    if (!p.by_itself || p.lap != 1) continue;
    driven.push_back({p.t_s, frame.to_local(p.at), p.yaw_rad, p.speed_mps, p.yaw_rate_radps});
  }
  if (driven.size() < 2) return r;
  std::vector<base::EnuPoint> vertices;
  vertices.reserve(course.nodes.size());
  double from_m = 0.0;
  bool found = false;
  for (std::size_t i = 0; i < course.nodes.size(); ++i) {
    vertices.push_back(course.nodes[i].at);
    if (found || course.nodes[i].item < first_item) continue;
    found = true;
    from_m = course.path.vertex_m[i];
  }
  r.measure = nav::measure_run(course.path, vertices, driven, from_m);
  for (const nav::CornerMeasure& c : r.measure.corners) {
    r.corner_items.push_back(course.nodes[std::min(c.vertex, course.nodes.size() - 1)].item);
  }
  for (const nav::StraightMeasure& s : r.measure.straights) {
    r.straight_items.push_back(item_at(course, s.to_m));
  }
  return r;
}

}  // namespace roverd::robot
