// From what is written down to shapes: walls of upright boxes, plants of spheres of leaves on a
// stem, people on two legs.

#include <algorithm>
#include <numbers>

#include "sim/world/draw.hpp"
#include "sim/world/scene.hpp"

namespace roverd::sim::world {
namespace {

constexpr double kPiece_m = 3.0;  ///< walls are built of pieces so long, which follow the ground
constexpr double kFoot_m = 0.3;   ///< walls go so deep, so that no gap shows on a slope
constexpr int kBushBalls = 9;
constexpr double kStem = 0.06;  ///< radius, of a plant's width

Shape standing(const Thing& thing, std::uint32_t number, Form form, Vec2 at, double low_m,
               double high_m) {
  Shape s;
  s.form = form;
  s.reflect = static_cast<float>(thing.reflect);
  s.thing = number;
  s.x = at.x;
  s.y = at.y;
  s.low_m = low_m;
  s.high_m = high_m;
  return s;
}

void build_wall(const Thing& thing, const Terrain& terrain, std::uint32_t number,
                std::vector<Shape>& out) {
  const bool in_air = thing.kind == Kind::Bar;
  const auto post = [&](Vec2 at) {
    const double ground = terrain.surface_m(at);
    Shape s =
        standing(thing, number, Form::Cylinder, at, ground + (in_air ? thing.bottom_m : -kFoot_m),
                 ground + (in_air ? thing.bottom_m : 0.0) + thing.height_m);
    s.a = thing.thickness_m / 2.0;
    out.push_back(s);
  };
  for (std::size_t i = 1; i < thing.points.size(); ++i) {
    const Vec2 a = thing.points[i - 1];
    const Vec2 along = thing.points[i] - a;
    const double long_m = length(along);
    if (long_m == 0.0) continue;
    const int count = std::max(1, static_cast<int>(std::ceil(long_m / kPiece_m)));
    for (int k = 0; k < count; ++k) {
      const Vec2 middle = a + ((k + 0.5) / count) * along;
      const double ground = terrain.surface_m(middle);
      Shape s =
          standing(thing, number, Form::Box, middle, ground + (in_air ? thing.bottom_m : -kFoot_m),
                   ground + (in_air ? thing.bottom_m : 0.0) + thing.height_m);
      s.a = long_m / count / 2.0;
      s.b = thing.thickness_m / 2.0;
      s.c = along.x / long_m;
      s.s = along.y / long_m;
      out.push_back(s);
    }
    if (i + 1 < thing.points.size()) post(thing.points[i]);
  }
}

/// A plant: a stem and balls of leaves in an ellipsoid of that radius and height over the ground.
void build_plant(const Thing& thing, const Terrain& terrain, std::uint32_t number, Vec2 at,
                 double radius_m, double height_m, int balls, Draw draw, std::vector<Shape>& out) {
  const double ground = terrain.surface_m(at);
  Shape stem = standing(thing, number, Form::Cylinder, at, ground, ground + 0.7 * height_m);
  stem.a = std::clamp(kStem * radius_m, 0.005, 0.15);
  out.push_back(stem);
  const double ball_m = std::min(0.62 * radius_m, height_m / 2.0);
  for (int i = 0; i < balls; ++i) {
    // Evenly up the plant, by chance around it; at half height they reach out farthest.
    const double up = (i + draw.uniform()) / balls;
    const double r_m = ball_m * draw.uniform(0.75, 1.0);
    const double middle = ground + r_m + up * (height_m - 2.0 * r_m);
    const double reach =
        (radius_m - r_m) * std::sqrt(std::max(0.0, 1.0 - (2 * up - 1) * (2 * up - 1)));
    const double around = draw.uniform(0.0, 2.0 * std::numbers::pi);
    Shape s = standing(thing, number, Form::Sphere,
                       {at.x + reach * std::cos(around), at.y + reach * std::sin(around)},
                       middle - r_m, middle + r_m);
    s.a = r_m;
    s.density_pm = static_cast<float>(thing.density_pm);
    out.push_back(s);
  }
}

void build_row(const World& world, const Terrain& terrain, std::uint32_t number,
               std::vector<Shape>& out) {
  const Thing& row = world.things[number];
  double total_m = 0.0;
  for (std::size_t i = 1; i < row.points.size(); ++i) {
    total_m += length(row.points[i] - row.points[i - 1]);
  }
  const Vec2 chord = row.points.back() - row.points.front();
  const double chord_m = std::max(length(chord), 1e-9);
  const Vec2 left{-chord.y / chord_m, chord.x / chord_m};
  const auto count = static_cast<int>(plants_of(row));
  std::size_t leg = 1;
  double before_m = 0.0;
  for (int k = 0; k < count; ++k) {
    const double along_m = k * row.spacing_m;
    double leg_m = length(row.points[leg] - row.points[leg - 1]);
    while (along_m > before_m + leg_m && leg + 1 < row.points.size()) {
      before_m += leg_m;
      ++leg;
      leg_m = length(row.points[leg] - row.points[leg - 1]);
    }
    Draw draw(world.seed ^ spread(number + 1), static_cast<std::uint64_t>(k));
    if (draw.uniform() < row.gaps) continue;
    const double share = leg_m > 0.0 ? (along_m - before_m) / leg_m : 0.0;
    const double over = total_m > 0.0 ? along_m / total_m : 0.0;
    const double jitter_m = 0.08 * row.width_m;
    Vec2 at = row.points[leg - 1] + share * (row.points[leg] - row.points[leg - 1]);
    at = at + (row.bend_m * 4.0 * over * (1.0 - over)) * left;
    at = at + Vec2{jitter_m * draw.uniform(-1.0, 1.0), jitter_m * draw.uniform(-1.0, 1.0)};
    build_plant(row, terrain, number, at, 0.5 * row.width_m * draw.uniform(0.8, 1.1),
                row.height_m * draw.uniform(0.8, 1.1), 4, draw, out);
  }
}

double path_m(const Thing& thing, bool closed) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < thing.points.size(); ++i) {
    sum += length(thing.points[i] - thing.points[i - 1]);
  }
  if (closed) sum += length(thing.points.front() - thing.points.back());
  return sum;
}

}  // namespace

std::string_view to_string(Kind kind) noexcept {
  switch (kind) {
    case Kind::Wall:
      return "wall";
    case Kind::Pole:
      return "pole";
    case Kind::Box:
      return "box";
    case Kind::Cone:
      return "cone";
    case Kind::Bush:
      return "bush";
    case Kind::Row:
      return "row";
    case Kind::Bar:
      return "bar";
    case Kind::Person:
      return "person";
    case Kind::Animal:
      return "animal";
    case Kind::Tag:
      return "tag";
  }
  return "thing";
}

bool moves(Kind kind) noexcept {
  return kind == Kind::Person || kind == Kind::Animal;
}

std::size_t plants_of(const Thing& row) noexcept {
  return 1 + static_cast<std::size_t>(path_m(row, false) / row.spacing_m);
}

void build_thing(const World& world, const Terrain& terrain, std::uint32_t number,
                 std::vector<Shape>& out) {
  const Thing& thing = world.things[number];
  const Vec2 at = thing.points.front();
  const double ground = terrain.surface_m(at);
  const auto one = [&](Form form, double low_m, double high_m, double a) -> Shape& {
    out.push_back(standing(thing, number, form, at, low_m, high_m));
    out.back().a = a;
    return out.back();
  };
  switch (thing.kind) {
    case Kind::Wall:
    case Kind::Bar:
      return build_wall(thing, terrain, number, out);
    case Kind::Pole:
      one(Form::Cylinder, ground, ground + thing.height_m, thing.radius_m);
      return;
    case Kind::Cone:
      one(Form::Cone, ground, ground + thing.height_m, thing.radius_m);
      return;
    case Kind::Box: {
      Shape& s = one(Form::Box, ground + thing.bottom_m, ground + thing.bottom_m + thing.height_m,
                     thing.length_m / 2.0);
      s.b = thing.width_m / 2.0;
      s.c = std::cos(thing.yaw_rad);
      s.s = std::sin(thing.yaw_rad);
      return;
    }
    case Kind::Tag: {  // its white edge, too: a tenth on each side
      constexpr double kPlate_m = 0.008;
      const double half_m = thing.length_m * 0.625;
      const Vec2 look{std::cos(thing.yaw_rad), std::sin(thing.yaw_rad)};
      const double middle_m = ground + thing.height_m;
      Shape& s = one(Form::Box, middle_m - half_m, middle_m + half_m, half_m);
      s.b = kPlate_m / 2.0;
      s.x -= kPlate_m / 2.0 * look.x;  // its face is where it is said to be
      s.y -= kPlate_m / 2.0 * look.y;
      s.c = -look.y;
      s.s = look.x;
      return;
    }
    case Kind::Bush:
      return build_plant(thing, terrain, number, at, thing.radius_m, thing.height_m, kBushBalls,
                         Draw(world.seed ^ spread(number + 1), 0), out);
    case Kind::Row:
      return build_row(world, terrain, number, out);
    case Kind::Person:
    case Kind::Animal:
      return;
  }
}

OnPath on_path(const Thing& thing, double at_s) noexcept {
  OnPath out;
  const auto& points = thing.points;
  const bool closed = thing.motion == Motion::Loop;
  const double whole_m = path_m(thing, closed);
  out.at = points.front();
  if (points.size() < 2 || whole_m <= 0.0) return out;
  double moving_s = std::max(0.0, at_s - thing.start_s);
  const double leg_s = whole_m / thing.speed_mps;
  const double round_s = leg_s + thing.pause_s;
  double way_m = 0.0;
  bool backwards = false;
  bool goes = at_s > thing.start_s;
  if (thing.motion == Motion::Once) {
    goes = goes && moving_s < leg_s;
    way_m = std::min(moving_s, leg_s) * thing.speed_mps;
    out.gone_m = way_m;
  } else {
    const double rounds = std::floor(moving_s / round_s);
    const double within_s = moving_s - rounds * round_s;
    goes = goes && within_s < leg_s;
    way_m = std::min(within_s, leg_s) * thing.speed_mps;
    out.gone_m = rounds * whole_m + way_m;
    backwards = thing.motion == Motion::Back && std::fmod(rounds, 2.0) == 1.0;
    if (backwards) way_m = whole_m - way_m;
  }
  const std::size_t legs = points.size() - (closed ? 0 : 1);
  for (std::size_t i = 0; i < legs; ++i) {
    const Vec2 a = points[i];
    const Vec2 b = points[(i + 1) % points.size()];
    const double long_m = length(b - a);
    if (way_m > long_m && i + 1 < legs) {
      way_m -= long_m;
      continue;
    }
    if (long_m == 0.0) continue;
    out.at = a + std::min(1.0, way_m / long_m) * (b - a);
    out.yaw_rad = std::atan2(b.y - a.y, b.x - a.x) + (backwards ? std::numbers::pi : 0.0);
    break;
  }
  out.speed_mps = goes ? thing.speed_mps : 0.0;
  return out;
}

void build_mover(const World& world, const Terrain& terrain, std::uint32_t number, double at_s,
                 std::vector<Shape>& out) {
  const Thing& thing = world.things[number];
  const OnPath on = on_path(thing, at_s);
  const double ground = terrain.surface_m(on.at);
  const double c = std::cos(on.yaw_rad);
  const double s = std::sin(on.yaw_rad);
  const auto put = [&](Form form, double forward, double left, double low, double high, double a,
                       double b) {
    Shape shape = standing(thing, number, form,
                           {on.at.x + c * forward - s * left, on.at.y + s * forward + c * left},
                           ground + low * thing.height_m, ground + high * thing.height_m);
    shape.moving = true;
    shape.a = a;
    shape.b = b;
    shape.c = c;
    shape.s = s;
    out.push_back(shape);
  };
  const double half_l = thing.length_m / 2.0;
  const double half_w = thing.width_m / 2.0;
  // Legs swing against each other, one swing and back for twice the height of way.
  const double phase = std::sin(2.0 * std::numbers::pi * on.gone_m / (0.85 * thing.height_m));
  if (thing.kind == Kind::Person) {
    const double swing_m = on.speed_mps > 0.0 ? 0.14 * thing.height_m * phase : 0.0;
    const double leg_m = 0.35 * half_w;
    put(Form::Cylinder, swing_m, 0.5 * half_w, 0.0, 0.48, leg_m, leg_m);
    put(Form::Cylinder, -swing_m, -0.5 * half_w, 0.0, 0.48, leg_m, leg_m);
    put(Form::Box, 0.0, 0.0, 0.46, 0.86, half_l, half_w);
    put(Form::Cylinder, 0.0, 0.0, 0.86, 1.0, 0.06 * thing.height_m, 0.0);
    return;
  }
  put(Form::Box, 0.0, 0.0, 0.4, 1.0, half_l, half_w);
  const double leg_m = 0.2 * half_w;
  const double swing_m = on.speed_mps > 0.0 ? 0.15 * half_l * phase : 0.0;
  for (const double end : {-0.7, 0.7}) {
    for (const double side : {-0.7, 0.7}) {
      put(Form::Cylinder, end * half_l + (end * side > 0.0 ? swing_m : -swing_m), side * half_w,
          0.0, 0.42, leg_m, leg_m);
    }
  }
}

}  // namespace roverd::sim::world
