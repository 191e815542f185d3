// What the drives through worlds say: a table for people, JSON for programs, plots.

#include <algorithm>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

using nlohmann::ordered_json;

// The room that a robot that has stopped shall have.
constexpr double kStandsLeast_m = 0.05;
constexpr double kStandsMost_m = 0.40;

struct Sums {
  std::size_t worlds = 0;
  std::size_t failed = 0;
  double km = 0.0;
  std::size_t ours = 0, crossed = 0, late = 0, beside = 0, unseen = 0, standing = 0, brushes = 0;
  std::size_t stops = 0, needless = 0, blind = 0, slows = 0, detours = 0;
  std::size_t near = 0, far = 0;  // of the stands
  std::vector<double> stands;

  void add(const WorldRun& run) {
    ++worlds;
    failed += run.problem.empty() ? 0 : 1;
    km += run.driven_m / 1e3;
    brushes += run.brushes;
    slows += run.slows;
    detours += run.detours;
    for (const TouchSeen& t : run.touches) {
      ++(t.blame == Blame::Ours     ? ours
         : t.blame == Blame::Late   ? late
         : t.blame == Blame::Beside ? beside
         : t.blame == Blame::Unseen ? unseen
                                    : standing);
      crossed += t.crossed ? 1 : 0;
    }
    for (const StopSeen& s : run.stops) {
      if (s.cause.empty()) {
        ++blind;
        continue;
      }
      ++stops;
      needless += s.needless ? 1 : 0;
      if (!s.stands_m) continue;
      stands.push_back(*s.stands_m);
      near += *s.stands_m < kStandsLeast_m ? 1 : 0;
      far += *s.stands_m > kStandsMost_m ? 1 : 0;
    }
  }
};

std::string row_of(const std::string& name, const Sums& s) {
  double mean = 0.0;
  double least = 0.0;
  double most = 0.0;
  if (!s.stands.empty()) {
    for (const double d : s.stands) mean += d / static_cast<double>(s.stands.size());
    least = *std::ranges::min_element(s.stands);
    most = *std::ranges::max_element(s.stands);
  }
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%-24s %6zu %8.3f %5zu %7zu %5zu %6zu %7zu %9zu %8zu %6zu %9zu %7.2f %6zu  %.2f/%.2f/%.2f "
      "%6zu %5zu %4zu %6zu %8zu\n",
      name.c_str(), s.worlds, s.km, s.ours, s.crossed, s.late, s.beside, s.unseen, s.standing,
      s.brushes, s.stops, s.needless, s.km > 0.0 ? static_cast<double>(s.needless) / s.km : 0.0,
      s.blind, least, mean, most, s.stands.size(), s.near, s.far, s.slows, s.detours);
  return text;
}

ordered_json touch_json(const TouchSeen& t) {
  return {{"at_s", t.at_s},
          {"thing", t.thing},
          {"blame", to_string(t.blame)},
          {"speed_mps", t.speed_mps},
          {"yaw_rate_radps", t.yaw_rate_radps},
          {"seen_before_s", t.seen_before_s},
          {"crossed", t.crossed},
          {"way_m", t.way_m},
          {"needed_m", t.needed_m},
          {"height_m", t.height_m},
          {"beams", t.beams},
          {"at", {t.at.east_m, t.at.north_m}}};
}

ordered_json stop_json(const StopSeen& s) {
  ordered_json out{{"at_s", s.at_s}, {"what", s.what}, {"at", {s.at.east_m, s.at.north_m}}};
  if (!s.cause.empty()) {
    out["cause"] = s.cause;
    out["needless"] = s.needless;
  }
  if (s.what != "blind") {
    out["sensor"] = s.sensor;
    out["age_s"] = s.age_s;
    out["rise_m"] = s.rise_m;
  }
  if (s.stands_m) {
    out["stands_m"] = *s.stands_m;
    out["thing"] = s.thing;
  }
  return out;
}

/// Of the worlds whose ways around were looked for in the truth as well.
std::string solved_text(const std::vector<WorldRun>& runs) {
  std::size_t ways = 0, solved = 0, none = 0, narrow = 0;
  for (const WorldRun& run : runs) {
    if (!run.way) continue;
    ++(*run.way ? ways : none);
    if (run.finished) ++(*run.way ? solved : narrow);
  }
  if (ways + none == 0) return {};
  return std::to_string(solved) + " of " + std::to_string(ways) +
         " worlds with a way that keeps 0.3 m were driven to the end, and " +
         std::to_string(narrow) + " of " + std::to_string(none) + " others\n";
}

const char* way_of(const Scenario& s) {
  return s.sticks ? "sticks" : s.course.reverse ? "backwards" : "ahead";
}

}  // namespace

bool remarkable(const WorldRun& run) noexcept {
  return std::ranges::any_of(run.touches, [](const auto& t) { return t.blame == Blame::Ours; }) ||
         std::ranges::any_of(run.stops, [](const auto& s) { return s.needless; });
}

std::string to_table(const std::vector<WorldRun>& runs) {
  std::map<std::string, Sums> rows;
  Sums all;
  for (const WorldRun& run : runs) {
    const Scenario& s = run.scenario;
    char speed[16];
    std::snprintf(speed, sizeof speed, "%.1f m/s", s.speed_mps);
    rows["1 " + s.kind].add(run);
    rows["2 " + std::string(way_of(s))].add(run);
    rows["3 " + std::string(speed)].add(run);
    rows["4 " + std::string(s.lidar ? "lidar" : "scanners")].add(run);
    rows["5 fault " + s.fault].add(run);
    all.add(run);
  }
  std::string out =
      "                         worlds       km  ours crossed  late beside  unseen  standing  "
      "brushes  "
      "stops  "
      "needless  per km  blind  stands m           of  near  far  slows  detours\n";
  for (const auto& [name, sums] : rows) out += row_of(name.substr(2), sums);
  out += row_of("all", all);
  out += solved_text(runs);
  if (all.failed > 0) out += std::to_string(all.failed) + " could not begin\n";
  return out;
}

std::string to_json(const std::vector<WorldRun>& runs, const Setup& setup) {
  ordered_json out;
  out["vehicle"] = setup.vehicle;
  ordered_json& list = out["runs"] = ordered_json::array();
  for (const WorldRun& run : runs) {
    const Scenario& s = run.scenario;
    ordered_json one{
        {"number", s.number},       {"world", s.world.name},    {"kind", s.kind},
        {"course", s.course.name},  {"speed_mps", s.speed_mps}, {"drive", way_of(s)},
        {"lidar", s.lidar},         {"fault", s.fault},         {"problem", run.problem},
        {"finished", run.finished}, {"driven_m", run.driven_m}, {"driven_s", run.driven_s},
        {"brushes", run.brushes},   {"slows", run.slows},       {"detours", run.detours}};
    if (run.way) one["way"] = *run.way;
    one["contacts"] = ordered_json::array();
    for (const TouchSeen& t : run.touches) one["contacts"].push_back(touch_json(t));
    one["stops"] = ordered_json::array();
    for (const StopSeen& t : run.stops) one["stops"].push_back(stop_json(t));
    ordered_json& track = one["track"] = ordered_json::array();
    for (const base::EnuPoint& p : run.track) track.push_back({p.east_m, p.north_m});
    list.push_back(std::move(one));
  }
  return out.dump(1);
}

std::string to_svg(const WorldRun& run) {
  std::string out =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-27 -27 54 54' width='1080' "
      "height='1080'>\n<rect x='-27' y='-27' width='54' height='54' fill='white'/>\n";
  char text[256];
  const auto circle = [&](double x, double y, double r, const char* colour) {
    std::snprintf(text, sizeof text, "<circle cx='%.2f' cy='%.2f' r='%.2f' fill='%s'/>\n", x, -y, r,
                  colour);
    out += text;
  };
  const auto line = [&](const char* colour, double width, const auto& points, auto&& x, auto&& y) {
    out += "<polyline fill='none' stroke='" + std::string(colour) + "' stroke-width='" +
           std::to_string(width) + "' points='";
    for (const auto& p : points) {
      std::snprintf(text, sizeof text, "%.2f,%.2f ", x(p), -y(p));
      out += text;
    }
    out += "'/>\n";
  };
  const auto wx = [](const auto& p) { return p.x; };
  const auto wy = [](const auto& p) { return p.y; };
  const auto ex = [](const auto& p) { return p.east_m; };
  const auto ey = [](const auto& p) { return p.north_m; };
  for (const auto& t : run.scenario.world.things) {
    if (t.points.empty()) continue;
    if (t.points.size() > 1) line("gray", std::max(0.05, t.thickness_m), t.points, wx, wy);
    const double size =
        std::max(0.05, t.kind == sim::world::Kind::Box ? 0.5 * t.width_m : t.radius_m);
    circle(t.points.front().x, t.points.front().y, size, "gray");
  }
  line("steelblue", 0.06, run.track, ex, ey);
  for (const StopSeen& s : run.stops) {
    circle(s.at.east_m, s.at.north_m, 0.12, s.needless ? "orange" : "green");
  }
  for (const TouchSeen& t : run.touches) {
    circle(t.at.east_m, t.at.north_m, 0.15, t.blame == Blame::Ours ? "red" : "brown");
  }
  return out + "</svg>\n";
}

}  // namespace roverd::study
