// A world as the text of its file: what is as usual is left out.

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "sim/world/kinds.hpp"

namespace roverd::sim::world {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kPerDegree = 0.017453292519943295;

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}
ordered_json place_json(Vec2 at) {
  return ordered_json::array({at.x, at.y});
}
ordered_json line_json(const std::vector<Vec2>& points) {
  ordered_json out = ordered_json::array();
  for (const Vec2 p : points) out.push_back(place_json(p));
  return out;
}
double heading_of(double yaw_rad) {
  double heading = std::fmod(90.0 - yaw_rad / kPerDegree, 360.0);
  if (heading < 0.0) heading += 360.0;
  return rounded(heading, 1e-9);
}

ordered_json thing_json(const Thing& thing) {
  const auto row =
      std::ranges::find_if(kinds(), [&](const KindRow& r) { return r.kind == thing.kind; });
  ordered_json out;
  out["kind"] = to_string(thing.kind);
  if (!thing.name.empty()) out["name"] = thing.name;
  if (row->places == Places::One) {
    out["at"] = place_json(thing.points.front());
  } else {
    out[row->places == Places::Line ? "points" : "path"] = line_json(thing.points);
  }
  if (row->turned && thing.yaw_rad != 0.0) out["heading_deg"] = heading_of(thing.yaw_rad);
  if (row->places == Places::Path && thing.motion != row->defaults.motion) {
    out["motion"] = word_of(thing.motion);
  }
  for (const Number& n : row->numbers) {
    if (thing.*n.at != row->defaults.*n.at) out[n.name] = thing.*n.at;
  }
  return out;
}

ordered_json ground_json(const Ground& g) {
  const Ground plain;
  ordered_json out = ordered_json::object();
  if (g.slope_rad != 0.0) {
    out["slope_deg"] = rounded(g.slope_rad / kPerDegree, 1e-9);
    out["uphill_deg"] = heading_of(g.uphill_rad);
  }
  if (g.grass_m != plain.grass_m) out["grass_m"] = g.grass_m;
  if (g.reflect != plain.reflect) out["reflect"] = g.reflect;
  for (const Uneven& u : g.uneven) {
    out["uneven"].push_back({{"height_m", u.height_m}, {"patch_m", u.patch_m}});
  }
  for (const Bump& b : g.bumps) {
    out["bumps"].push_back(
        {{"at", place_json(b.at)}, {"radius_m", b.radius_m}, {"height_m", b.height_m}});
  }
  for (const Drop& d : g.drops) {
    out["drops"].push_back({{"points", line_json(d.points)}, {"depth_m", d.depth_m}});
  }
  return out;
}

}  // namespace

std::string write_world(const World& world) {
  ordered_json out;
  out["name"] = world.name;
  out["seed"] = world.seed;
  if (ordered_json ground = ground_json(world.ground); !ground.empty()) {
    out["ground"] = std::move(ground);
  }
  // One thing a line: people read and edit these files.
  std::string text = out.dump(1, ' ', false, json::error_handler_t::replace);
  text.pop_back();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text += ",\n \"things\": [";
  for (std::size_t i = 0; i < world.things.size(); ++i) {
    text += i == 0 ? "\n  " : ",\n  ";
    text += thing_json(world.things[i]).dump(-1, ' ', false, json::error_handler_t::replace);
  }
  return text + (world.things.empty() ? "]\n}\n" : "\n ]\n}\n");
}

}  // namespace roverd::sim::world
