// What a study says: a table for people, JSON for programs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

#include "base/angle.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

using nlohmann::ordered_json;

/// The runs of one course under one disturbance.
struct Group {
  std::string name;
  std::vector<const Run*> runs;
};

std::vector<Group> groups(const std::vector<Run>& runs) {
  std::vector<Group> out;
  for (const Run& run : runs) {
    const std::string name = run.course + " / " + run.disturbance;
    auto found =
        std::find_if(out.begin(), out.end(), [&](const Group& g) { return g.name == name; });
    if (found == out.end()) found = out.insert(out.end(), {name, {}});
    found->runs.push_back(&run);
  }
  return out;
}

struct Column {
  const char* head;
  double (*of)(const Run&);
  int decimals;
};

constexpr std::array kColumns{
    Column{"rms m", [](const Run& r) { return r.truth.cross.rms_m; }, 3},
    Column{"mean m", [](const Run& r) { return r.truth.cross.mean_m; }, 3},
    Column{"p95 m", [](const Run& r) { return r.truth.cross.p95_m; }, 3},
    Column{"max m", [](const Run& r) { return r.truth.cross.max_m; }, 3},
    Column{"corner m", [](const Run& r) { return r.truth.corner_mean_m; }, 3},
    Column{"slalom m", [](const Run& r) { return r.truth.slalom_mean_m; }, 3},
    Column{"swept m", [](const Run& r) { return r.swept_half_width_m; }, 3},
    Column{"believed rms", [](const Run& r) { return r.believed.cross.rms_m; }, 3},
    Column{"in 95 %", [](const Run& r) { return r.honesty.inside_pct; }, 1},
    Column{"heading deg",
           [](const Run& r) { return base::deg_from_rad(r.honesty.heading_rms_rad); }, 2},
    Column{"of sigma", [](const Run& r) { return r.honesty.heading_sigmas; }, 2},
    Column{"resets", [](const Run& r) { return static_cast<double>(r.honesty.resets); }, 0},
    Column{"time s", [](const Run& r) { return r.truth.time_s; }, 1},
};

std::string cell(const Column& column, const Group& group) {
  double sum = 0.0;
  double worst = 0.0;
  for (const Run* run : group.runs) {
    const double value = column.of(*run);
    sum += value;
    worst = std::max(worst, value);
  }
  std::array<char, 64> text{};
  const auto n = static_cast<double>(group.runs.size());
  if (group.runs.size() == 1) {
    std::snprintf(text.data(), text.size(), "%.*f", column.decimals, worst);
  } else {
    std::snprintf(text.data(), text.size(), "%.*f/%.*f", column.decimals, sum / n, column.decimals,
                  worst);
  }
  return text.data();
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() >= width ? text : text + std::string(width - text.size(), ' ');
}

ordered_json cross_json(const nav::CrossTrack& c) {
  return {{"rms_m", c.rms_m}, {"mean_m", c.mean_m}, {"p95_m", c.p95_m}, {"max_m", c.max_m}};
}

ordered_json measure_json(const nav::RunMeasure& m) {
  ordered_json corners = ordered_json::array();
  for (const nav::CornerMeasure& c : m.corners) {
    corners.push_back({{"vertex", c.vertex},
                       {"s_m", c.s_m},
                       {"deflection_deg", base::deg_from_rad(c.deflection_rad)},
                       {"distance_m", c.distance_m},
                       {"inside_m", c.inside_m},
                       {"outside_m", c.outside_m}});
  }
  ordered_json straights = ordered_json::array();
  for (const nav::StraightMeasure& s : m.straights) {
    straights.push_back({{"from_m", s.from_m}, {"to_m", s.to_m}, {"slalom_m", s.slalom_m}});
  }
  return {{"time_s", m.time_s},
          {"driven_m", m.driven_m},
          {"cross_track", cross_json(m.cross)},
          {"corner_mean_m", m.corner_mean_m},
          {"corner_max_m", m.corner_max_m},
          {"cut_max_m", m.cut_max_m},
          {"overshoot_max_m", m.overshoot_max_m},
          {"slalom_mean_m", m.slalom_mean_m},
          {"slalom_max_m", m.slalom_max_m},
          {"heading_rms_deg", base::deg_from_rad(m.heading_rms_rad)},
          {"yaw_accel_rms_radps2", m.yaw_accel_rms_radps2},
          {"jerk_rms_mps3", m.jerk_rms_mps3},
          {"end_m", m.end_m},
          {"corners", corners},
          {"straights", straights}};
}

}  // namespace

std::string to_table(const std::vector<Run>& runs) {
  std::vector<std::vector<std::string>> rows(1);
  rows[0].push_back("course / disturbance");
  for (const Column& c : kColumns) rows[0].emplace_back(c.head);
  rows[0].emplace_back("failed");
  for (const Group& g : groups(runs)) {
    std::vector<std::string> row{g.name};
    for (const Column& c : kColumns) row.push_back(cell(c, g));
    const auto failed = std::count_if(g.runs.begin(), g.runs.end(),
                                      [](const Run* r) { return !r->problem.empty(); });
    row.push_back(std::to_string(failed) + " of " + std::to_string(g.runs.size()));
    rows.push_back(std::move(row));
  }
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += padded(row[i], widths[i]) + "  ";
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  for (const Run& run : runs) {
    if (run.problem.empty()) continue;
    out += run.course + " / " + run.disturbance + ", seed " + std::to_string(run.seed) + ": " +
           run.problem + "\n";
  }
  return out;
}

namespace {

double to_mm(double metres) {
  return std::round(metres * 1000.0) / 1000.0;
}

ordered_json track_json(const Run& run) {
  ordered_json out = ordered_json::array();
  for (const nav::DrivenPoint& p : run.driven) {
    out.push_back(
        ordered_json::array({to_mm(p.t_s), to_mm(p.at.east_m), to_mm(p.at.north_m),
                             to_mm(base::heading_from_yaw(p.yaw_rad)), to_mm(p.speed_mps)}));
  }
  return out;
}

ordered_json way_json(const Run& run) {
  ordered_json out = ordered_json::array();
  for (const base::EnuPoint& p : run.way) {
    out.push_back(ordered_json::array({to_mm(p.east_m), to_mm(p.north_m)}));
  }
  return out;
}

}  // namespace

std::string to_json(const std::vector<Run>& runs, const Setup& setup) {
  ordered_json ways = ordered_json::object();
  ordered_json list = ordered_json::array();
  for (const Run& r : runs) {
    if (!r.way.empty() && !ways.contains(r.course)) ways[r.course] = way_json(r);
    list.push_back({{"course", r.course},
                    {"disturbance", r.disturbance},
                    {"seed", r.seed},
                    {"problem", r.problem.empty() ? ordered_json() : ordered_json(r.problem)},
                    {"truth", measure_json(r.truth)},
                    {"believed", measure_json(r.believed)},
                    {"honesty",
                     {{"inside_pct", r.honesty.inside_pct},
                      {"position_rms_m", r.honesty.position_rms_m},
                      {"heading_rms_deg", base::deg_from_rad(r.honesty.heading_rms_rad)},
                      {"heading_sigmas", r.honesty.heading_sigmas},
                      {"resets", r.honesty.resets}}},
                    {"swept_half_width_m", r.swept_half_width_m},
                    {"tick_p99_us", r.tick_p99_us},
                    {"track", track_json(r)}});
  }
  const ordered_json whole{
      {"vehicle", setup.vehicle},
      {"plant", setup.plant.empty() ? ordered_json() : ordered_json(setup.plant)},
      {"set", setup.overrides},
      {"runs", list},
      {"ways", ways}};
  return whole.dump(1) + "\n";
}

}  // namespace roverd::study
