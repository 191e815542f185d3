// The file format of worlds, both ways. One table says which members a kind has, what they may be
// and what they are when left out.

#include <algorithm>
#include <array>
#include <optional>

#include <nlohmann/json.hpp>

#include "sim/world/world.hpp"

namespace roverd::sim::world {
namespace {

using base::Result;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr double kDegree = 0.017453292519943295;
constexpr std::size_t kMostLayers = 8;
constexpr std::size_t kMostBumps = 256;
constexpr std::size_t kMostDrops = 64;

/// A number of a thing: its name, where it is kept, its range.
struct Number {
  const char* name;
  double Thing::*at;
  double low;
  double high;
};
constexpr Number kHeight{"height_m", &Thing::height_m, 0.01, 100.0};
constexpr Number kBottom{"bottom_m", &Thing::bottom_m, 0.0, 100.0};
constexpr Number kThickness{"thickness_m", &Thing::thickness_m, 0.005, 10.0};
constexpr Number kRadius{"radius_m", &Thing::radius_m, 0.002, 50.0};
constexpr Number kLength{"length_m", &Thing::length_m, 0.01, 1'000.0};
constexpr Number kWidth{"width_m", &Thing::width_m, 0.01, 1'000.0};
constexpr Number kDensity{"density_pm", &Thing::density_pm, 0.01, 1'000.0};
constexpr Number kReflect{"reflect", &Thing::reflect, 0.0, 1.0};
constexpr Number kSpacing{"spacing_m", &Thing::spacing_m, 0.02, 100.0};
constexpr Number kGaps{"gaps", &Thing::gaps, 0.0, 1.0};
constexpr Number kBend{"bend_m", &Thing::bend_m, -500.0, 500.0};
constexpr Number kSpeed{"speed_mps", &Thing::speed_mps, 0.01, 30.0};
constexpr Number kPause{"pause_s", &Thing::pause_s, 0.0, 86'400.0};
constexpr Number kStart{"start_s", &Thing::start_s, 0.0, 86'400.0};

enum class Places { One, Line, Path };

struct KindRow {
  Kind kind;
  Places places;
  std::vector<Number> numbers;
  bool turned = false;  ///< has heading_deg
  Thing defaults{};
};

Thing like(Kind kind, double height_m, double length_m, double width_m, double radius_m,
           double thickness_m) {
  Thing t;
  t.kind = kind;
  t.height_m = height_m;
  t.length_m = length_m;
  t.width_m = width_m;
  t.radius_m = radius_m;
  t.thickness_m = thickness_m;
  return t;
}

const std::vector<KindRow>& kinds() {
  static const std::vector<KindRow> rows = {
      {Kind::Wall,
       Places::Line,
       {kHeight, kThickness, kReflect},
       false,
       like(Kind::Wall, 2.0, 1.0, 1.0, 0.1, 0.2)},
      {Kind::Bar,
       Places::Line,
       {kHeight, kBottom, kThickness, kReflect},
       false,
       like(Kind::Bar, 0.1, 1.0, 1.0, 0.1, 0.1)},
      {Kind::Pole,
       Places::One,
       {kHeight, kRadius, kReflect},
       false,
       like(Kind::Pole, 2.0, 1.0, 1.0, 0.05, 0.2)},
      {Kind::Box,
       Places::One,
       {kHeight, kBottom, kLength, kWidth, kReflect},
       true,
       like(Kind::Box, 1.0, 1.0, 1.0, 0.1, 0.2)},
      {Kind::Cone,
       Places::One,
       {kHeight, kRadius, kReflect},
       false,
       like(Kind::Cone, 0.5, 1.0, 1.0, 0.18, 0.2)},
      {Kind::Bush,
       Places::One,
       {kHeight, kRadius, kDensity, kReflect},
       false,
       like(Kind::Bush, 1.0, 1.0, 1.0, 0.5, 0.2)},
      {Kind::Row,
       Places::Line,
       {kHeight, kWidth, kSpacing, kGaps, kBend, kDensity, kReflect},
       false,
       like(Kind::Row, 1.5, 1.0, 0.8, 0.1, 0.2)},
      {Kind::Person,
       Places::Path,
       {kHeight, kLength, kWidth, kSpeed, kPause, kStart, kReflect},
       false,
       like(Kind::Person, 1.75, 0.3, 0.46, 0.1, 0.2)},
      {Kind::Animal,
       Places::Path,
       {kHeight, kLength, kWidth, kSpeed, kPause, kStart, kReflect},
       false,
       like(Kind::Animal, 0.6, 0.8, 0.25, 0.1, 0.2)}};
  return rows;
}

std::string_view word_of(Motion motion) noexcept {
  return motion == Motion::Once ? "once" : motion == Motion::Loop ? "loop" : "back";
}

/// The first problem stops the reading; it is kept with its place.
class Reader {
 public:
  Result<World> read(std::string_view text) {
    if (text.size() > kMaxText)
      return base::fail(base::Code::TooLarge, "a world has 32 MB at most");
    const json object = json::parse(text, nullptr, false);
    if (object.is_discarded()) return base::fail(base::Code::Malformed, "a world must be JSON");
    World world;
    members(object, "", {"name", "seed", "ground", "things"});
    if (const json* name = member(object, "name")) word(*name, "/name", world.name);
    double seed = 1.0;
    number(object, "", "seed", seed, 0.0, 9e15, true);
    world.seed = static_cast<std::uint64_t>(seed);
    if (const json* ground = member(object, "ground")) read_ground(*ground, world.ground);
    each(object, "", "things", kMaxThings,
         [&](const json& one, const std::string& at) { read_thing(one, at, world.things); });
    check_size(world);
    if (problem_) return tl::unexpected(*problem_);
    return world;
  }

 private:
  void refuse(const std::string& at, const std::string& what) {
    if (problem_) return;
    const std::string where = at.empty() ? "the world" : at;
    problem_ = base::Error{base::Code::Invalid, where + " " + what, {{at, what}}};
  }

  const json* member(const json& object, const char* name) const {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }

  void members(const json& object, const std::string& at, std::vector<std::string_view> known) {
    if (!object.is_object()) return refuse(at, "must be an object");
    for (const auto& [name, value] : object.items()) {
      if (std::ranges::find(known, name) == known.end())
        return refuse(at + "/" + name, "is unknown");
    }
  }

  void word(const json& value, const std::string& at, std::string& out) {
    if (!value.is_string()) return refuse(at, "must be a text");
    out = value.get<std::string>();
    if (out.size() > 100) refuse(at, "must be at most 100 bytes long");
  }

  void number_value(const json& value, const std::string& at, double& out, double low, double high,
                    bool whole = false) {
    if (!value.is_number()) return refuse(at, "must be a number");
    const double given = value.get<double>();
    if (!(given >= low && given <= high)) {
      return refuse(at, "must lie in " + json(low).dump() + " .. " + json(high).dump());
    }
    if (whole && given != std::floor(given)) return refuse(at, "must be a whole number");
    out = given;
  }

  void number(const json& object, const std::string& at, const char* name, double& out, double low,
              double high, bool whole = false) {
    if (const json* value = member(object, name)) {
      number_value(*value, at + "/" + name, out, low, high, whole);
    }
  }

  void required(const json& object, const std::string& at, const char* name, double& out,
                double low, double high) {
    if (member(object, name) == nullptr) return refuse(at + "/" + name, "is missing");
    number(object, at, name, out, low, high);
  }

  template <class F>
  void each(const json& object, const std::string& at, const char* name, std::size_t most, F one) {
    const json* list = member(object, name);
    if (list == nullptr) return;
    const std::string here = at + "/" + name;
    if (!list->is_array()) return refuse(here, "must be a list");
    if (list->size() > most) return refuse(here, "has more than " + std::to_string(most));
    for (std::size_t i = 0; i < list->size() && !problem_; ++i) {
      one((*list)[i], here + "/" + std::to_string(i));
    }
  }

  Vec2 place(const json& value, const std::string& at) {
    Vec2 out;
    if (!value.is_array() || value.size() != 2) {
      refuse(at, "must be [east_m, north_m]");
      return out;
    }
    number_value(value[0], at + "/0", out.x, -kReach_m, kReach_m);
    number_value(value[1], at + "/1", out.y, -kReach_m, kReach_m);
    return out;
  }

  std::vector<Vec2> line(const json& object, const std::string& at, const char* name,
                         std::size_t least) {
    std::vector<Vec2> out;
    if (member(object, name) == nullptr) refuse(at + "/" + name, "is missing");
    each(object, at, name, kMaxPoints,
         [&](const json& one, const std::string& where) { out.push_back(place(one, where)); });
    if (out.size() < least) {
      refuse(at + "/" + name, "must have at least " + std::to_string(least));
    }
    return out;
  }

  void read_ground(const json& object, Ground& ground) {
    const std::string at = "/ground";
    members(object, at,
            {"slope_deg", "uphill_deg", "grass_m", "reflect", "uneven", "bumps", "drops"});
    double slope = 0.0;
    double uphill = 90.0;
    number(object, at, "slope_deg", slope, 0.0, 45.0);
    number(object, at, "uphill_deg", uphill, 0.0, 360.0);
    ground.slope_rad = slope * kDegree;
    ground.uphill_rad = (90.0 - uphill) * kDegree;
    number(object, at, "grass_m", ground.grass_m, 0.0, 2.0);
    number(object, at, "reflect", ground.reflect, 0.0, 1.0);
    each(object, at, "uneven", kMostLayers, [&](const json& one, const std::string& where) {
      members(one, where, {"height_m", "patch_m"});
      Uneven u;
      required(one, where, "height_m", u.height_m, 0.0, 20.0);
      required(one, where, "patch_m", u.patch_m, 0.1, 1'000.0);
      ground.uneven.push_back(u);
    });
    each(object, at, "bumps", kMostBumps, [&](const json& one, const std::string& where) {
      members(one, where, {"at", "radius_m", "height_m"});
      Bump b;
      if (const json* p = member(one, "at")) {
        b.at = place(*p, where + "/at");
      } else {
        refuse(where + "/at", "is missing");
      }
      required(one, where, "radius_m", b.radius_m, 0.05, 500.0);
      required(one, where, "height_m", b.height_m, -20.0, 20.0);
      ground.bumps.push_back(b);
    });
    each(object, at, "drops", kMostDrops, [&](const json& one, const std::string& where) {
      members(one, where, {"points", "depth_m"});
      Drop d;
      d.points = line(one, where, "points", 3);
      required(one, where, "depth_m", d.depth_m, 0.01, 100.0);
      ground.drops.push_back(std::move(d));
    });
  }

  void read_thing(const json& object, const std::string& at, std::vector<Thing>& out) {
    if (!object.is_object()) return refuse(at, "must be an object");
    std::string kind;
    if (const json* value = member(object, "kind")) word(*value, at + "/kind", kind);
    const auto row =
        std::ranges::find_if(kinds(), [&](const KindRow& r) { return to_string(r.kind) == kind; });
    if (row == kinds().end()) {
      return refuse(at + "/kind",
                    "must be wall, bar, pole, box, cone, bush, row, person or animal");
    }
    std::vector<std::string_view> known = {"kind", "name"};
    known.push_back(row->places == Places::One    ? "at"
                    : row->places == Places::Line ? "points"
                                                  : "path");
    if (row->turned) known.push_back("heading_deg");
    if (row->places == Places::Path) known.push_back("motion");
    for (const Number& n : row->numbers) known.push_back(n.name);
    members(object, at, known);
    Thing thing = row->defaults;
    if (const json* name = member(object, "name")) word(*name, at + "/name", thing.name);
    for (const Number& n : row->numbers) number(object, at, n.name, thing.*n.at, n.low, n.high);
    if (row->places == Places::One) {
      if (const json* p = member(object, "at")) {
        thing.points = {place(*p, at + "/at")};
      } else {
        refuse(at + "/at", "is missing");
      }
    } else {
      const bool is_line = row->places == Places::Line;
      thing.points = line(object, at, is_line ? "points" : "path", is_line ? 2 : 1);
    }
    double heading = 90.0;
    number(object, at, "heading_deg", heading, -360.0, 360.0);
    thing.yaw_rad = (90.0 - heading) * kDegree;
    if (const json* motion = member(object, "motion")) read_motion(*motion, at + "/motion", thing);
    if (!problem_) out.push_back(std::move(thing));
  }

  void read_motion(const json& value, const std::string& at, Thing& thing) {
    for (const Motion m : {Motion::Once, Motion::Loop, Motion::Back}) {
      if (!value.is_string() || value.get<std::string>() != word_of(m)) continue;
      thing.motion = m;
      return;
    }
    refuse(at, "must be once, loop or back");
  }

  void check_size(const World& world) {
    std::size_t plants = 0;
    double wall_m = 0.0;
    for (std::size_t i = 0; i < world.things.size() && !problem_; ++i) {
      const Thing& t = world.things[i];
      const std::string at = "/things/" + std::to_string(i);
      if (t.kind == Kind::Row) plants += plants_of(t);
      if (plants > kMaxPlants) {
        refuse(at, "makes it more than " + std::to_string(kMaxPlants) + " plants");
      }
      if (t.kind != Kind::Wall && t.kind != Kind::Bar) continue;
      for (std::size_t k = 1; k < t.points.size(); ++k) {
        wall_m += length(t.points[k] - t.points[k - 1]);
      }
      if (wall_m > 1e6) refuse(at, "makes it more than 1000 km of walls");
    }
  }

  std::optional<base::Error> problem_;
};

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
  double heading = std::fmod(90.0 - yaw_rad / kDegree, 360.0);
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
    out["slope_deg"] = rounded(g.slope_rad / kDegree, 1e-9);
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

Result<World> read_world(std::string_view text) {
  return Reader().read(text);
}

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
