#include "tools/report.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "robot/run_report.hpp"
#include "store/store.hpp"

namespace roverd {
namespace {

struct Column {
  store::RunHead head;
  robot::RunReport report;
};

struct Row {
  const char* name;
  int digits;
  std::function<double(const Column&)> value;  ///< NaN: not known
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Measured = double (*)(const nav::RunMeasure&);

/// A figure is told where there is enough to tell it of.
std::function<double(const Column&)> if_told(bool (robot::RunReport::*tells)() const noexcept,
                                             Measured value) {
  return [tells, value](const Column& c) {
    return (c.report.*tells)() ? value(c.report.measure) : kUnknown;
  };
}

std::function<double(const Column&)> of_way(Measured value) {
  return if_told(&robot::RunReport::tells_way, value);
}
std::function<double(const Column&)> of_corners(Measured value) {
  return if_told(&robot::RunReport::tells_corners, value);
}
std::function<double(const Column&)> of_straights(Measured value) {
  return if_told(&robot::RunReport::tells_straights, value);
}

const std::vector<Row>& rows() {
  using M = nav::RunMeasure;
  static const std::vector<Row> all{
      {"time, s", 1, [](const Column& c) { return c.report.time_s; }},
      {"driven by itself, s", 1, [](const Column& c) { return c.report.driving_s; }},
      {"way, m", 1, [](const Column& c) { return c.report.driven_m; }},
      {"of it to the first item, m", 1,
       [](const Column& c) { return c.report.approach ? c.report.approach->driven_m : 0.0; }},
      {"energy, Wh", 1, [](const Column& c) { return c.report.energy_wh.value_or(kUnknown); }},
      {"cross-track rms, m", 3, of_way([](const M& m) { return m.cross.rms_m; })},
      {"cross-track mean, m", 3, of_way([](const M& m) { return m.cross.mean_m; })},
      {"cross-track 95 %, m", 3, of_way([](const M& m) { return m.cross.p95_m; })},
      {"cross-track max, m", 3, of_way([](const M& m) { return m.cross.max_m; })},
      {"corner distance mean, m", 3, of_corners([](const M& m) { return m.corner_mean_m; })},
      {"corner distance max, m", 3, of_corners([](const M& m) { return m.corner_max_m; })},
      {"cut corner max, m", 3, of_corners([](const M& m) { return m.cut_max_m; })},
      {"overshoot max, m", 3, of_corners([](const M& m) { return m.overshoot_max_m; })},
      {"slalom max, m", 3, of_straights([](const M& m) { return m.slalom_max_m; })},
      {"slalom mean, m", 3, of_straights([](const M& m) { return m.slalom_mean_m; })},
      {"heading rms, deg", 2,
       of_way([](const M& m) { return base::deg_from_rad(m.heading_rms_rad); })},
      {"turn smoothness, deg/s2", 2,
       of_way([](const M& m) { return base::deg_from_rad(m.yaw_accel_rms_radps2); })},
      {"jerk rms, m/s3", 3, of_way([](const M& m) { return m.jerk_rms_mps3; })},
      {"end missed by, m", 3, of_way([](const M& m) { return m.end_m; })}};
  return all;
}

int complain(const std::string& why) {
  std::fprintf(stderr, "roverd report: %s\n", why.c_str());
  return 2;
}

base::Result<Column> column_of(const std::filesystem::path& database, std::int64_t id) {
  const auto read = store::read_run(database, id);
  if (!read) return tl::unexpected(read.error());
  std::vector<robot::ReportPoint> track;
  track.reserve(read->points.size());
  for (const store::RunPoint& p : read->points) {
    track.push_back({p.t_s, p.at, p.yaw_rad, p.speed_mps, p.yaw_rate_radps, p.lap, p.by_itself,
                     p.power_w, p.item, p.cross_m});
  }
  std::vector<std::pair<std::string, base::ParamValue>> parameters;
  for (const auto& p : read->run.parameters) parameters.emplace_back(p.name, p.value);
  auto made = robot::report_run(read->run.plan, track, read->run.head.first_item, parameters);
  if (!made) return tl::unexpected(made.error());
  return Column{read->run.head, std::move(*made)};
}

void print(const std::vector<Column>& columns) {
  std::printf("%-26s", "");
  for (const Column& c : columns) {
    std::printf(" %14s", ("run " + std::to_string(c.head.id)).c_str());
  }
  std::printf("\n%-26s", "mission");
  for (const Column& c : columns) std::printf(" %14.14s", c.head.name.c_str());
  std::printf("\n%-26s", "outcome");
  for (const Column& c : columns)
    std::printf(" %14s", std::string(to_string(c.head.outcome)).c_str());
  std::printf("\n");
  for (const Row& row : rows()) {
    std::printf("%-26s", row.name);
    for (const Column& c : columns) {
      const double value = row.value(c);
      if (std::isfinite(value)) {
        std::printf(" %14.*f", row.digits, value);
      } else {
        std::printf(" %14s", "-");
      }
    }
    std::printf("\n");
  }
}

}  // namespace

int report(const std::filesystem::path& data, const std::vector<std::int64_t>& runs) {
  std::vector<Column> columns;
  for (const std::int64_t id : runs) {
    auto column = column_of(data / "roverd.db", id);
    if (!column) {
      (void)complain(column.error().detail);
      return column.error().code == base::Code::Unavailable ? 1 : 2;
    }
    columns.push_back(std::move(*column));
  }
  print(columns);
  return 0;
}

}  // namespace roverd
