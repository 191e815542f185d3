// The file of a world, read: one table (kinds.hpp) says which members a kind has, what they may be
// and what they are when left out.

#include <algorithm>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "sim/world/kinds.hpp"

namespace roverd::sim::world {
namespace {

using base::Result;
using nlohmann::json;

constexpr double kDegree = 0.017453292519943295;
constexpr std::size_t kMostLayers = 8;
constexpr std::size_t kMostBumps = 256;
constexpr std::size_t kMostDrops = 64;

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
                    "must be wall, bar, pole, box, cone, bush, row, person, animal or tag");
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

}  // namespace

Result<World> read_world(std::string_view text) {
  return Reader().read(text);
}

}  // namespace roverd::sim::world
