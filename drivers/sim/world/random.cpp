#include "sim/world/random.hpp"

#include <charconv>
#include <numbers>

#include "sim/world/draw.hpp"

namespace roverd::sim::world {
namespace {

constexpr double kFree_m = 2.5;
constexpr RandomKind kAllKinds[] = {RandomKind::Static, RandomKind::Moving, RandomKind::Grass,
                                    RandomKind::Crowded};

/// To the centimetre, so that the written world is the drawn one.
double cm(double value) {
  return std::round(value * 100.0) / 100.0;
}

class Maker {
 public:
  Maker(std::uint64_t seed, RandomKind kind)
      : draw_(seed, static_cast<std::uint64_t>(kind) + 1), around_m_(25.0) {
    world_.name = "random:" + std::to_string(seed) + ":" + std::string(to_string(kind));
    world_.seed = seed;
  }

  World make(RandomKind kind) {
    ground(kind);
    switch (kind) {
      case RandomKind::Static:
        for (int i = 10 + draw_.below(50); i > 0; --i) standing();
        break;
      case RandomKind::Moving:
        for (int i = 4 + draw_.below(16); i > 0; --i) standing();
        for (int i = 1 + draw_.below(5); i > 0; --i) moving();
        break;
      case RandomKind::Grass:
        break;
      case RandomKind::Crowded:
        around_m_ = 100.0;
        for (int i = 0; i < 10'000; ++i) standing();
        break;
    }
    return std::move(world_);
  }

 private:
  void ground(RandomKind kind) {
    Ground& g = world_.ground;
    const bool grass = kind == RandomKind::Grass;
    g.uneven = {{cm(grass ? draw_.uniform(0.03, 0.06) : draw_.uniform(0.0, 0.03)),
                 cm(draw_.uniform(0.5, 1.5))}};
    if (grass || draw_.uniform() < 0.3) {
      g.uneven.push_back({cm(draw_.uniform(0.1, 0.4)), cm(draw_.uniform(8.0, 20.0))});
    }
    if (grass) g.grass_m = cm(draw_.uniform(0.05, 0.15));
    if (draw_.uniform() >= 0.3) return;
    g.slope_rad = std::round(draw_.uniform(1.0, 10.0)) * std::numbers::pi / 180.0;
    g.uphill_rad = (90.0 - std::round(draw_.uniform(0.0, 359.0))) * std::numbers::pi / 180.0;
  }

  Vec2 place(double room_m) {
    while (true) {
      const Vec2 at{cm(draw_.uniform(-around_m_, around_m_)),
                    cm(draw_.uniform(-around_m_, around_m_))};
      if (length(at) > kFree_m + room_m) return at;
    }
  }

  double reflect() { return cm(draw_.uniform(0.08, 0.9)); }

  void standing() {
    Thing t;
    t.reflect = reflect();
    const double what = draw_.uniform();
    if (what < 0.30) {
      t.kind = Kind::Pole;
      t.radius_m = cm(draw_.uniform(0.02, 0.25));
      t.height_m = cm(draw_.uniform(0.5, 3.0));
    } else if (what < 0.60) {
      t.kind = Kind::Box;
      t.length_m = cm(draw_.uniform(0.2, 2.0));
      t.width_m = cm(draw_.uniform(0.2, 1.5));
      t.height_m = cm(draw_.uniform(0.2, 2.0));
      t.yaw_rad = (90.0 - std::round(draw_.uniform(0.0, 359.0))) * std::numbers::pi / 180.0;
    } else if (what < 0.72) {
      t.kind = Kind::Cone;
      t.radius_m = cm(draw_.uniform(0.12, 0.25));
      t.height_m = cm(draw_.uniform(0.3, 0.75));
    } else if (what < 0.85) {
      t.kind = Kind::Bush;
      t.radius_m = cm(draw_.uniform(0.3, 1.0));
      t.height_m = cm(draw_.uniform(0.4, 1.8));
      t.density_pm = std::round(draw_.uniform(2.0, 10.0));
    } else {
      line(what < 0.95 ? Kind::Wall : Kind::Bar, std::move(t));
      return;
    }
    t.points = {place(1.3)};
    world_.things.push_back(std::move(t));
  }

  void line(Kind kind, Thing t) {
    t.kind = kind;
    const double long_m = draw_.uniform(1.0, 6.0);
    const double yaw = draw_.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec2 from = place(long_m + 0.3);
    t.points = {from, {cm(from.x + long_m * std::cos(yaw)), cm(from.y + long_m * std::sin(yaw))}};
    t.height_m = cm(kind == Kind::Wall ? draw_.uniform(0.4, 2.5) : draw_.uniform(0.05, 0.2));
    t.thickness_m = cm(draw_.uniform(0.05, 0.3));
    if (kind == Kind::Bar) t.bottom_m = cm(draw_.uniform(0.15, 1.2));
    world_.things.push_back(std::move(t));
  }

  void moving() {
    Thing t;
    const bool person = draw_.uniform() < 0.7;
    t.kind = person ? Kind::Person : Kind::Animal;
    t.height_m = cm(person ? draw_.uniform(1.1, 1.95) : draw_.uniform(0.35, 1.2));
    t.length_m = cm(person ? 0.3 : draw_.uniform(0.5, 1.5));
    t.width_m = cm(person ? draw_.uniform(0.35, 0.55) : draw_.uniform(0.2, 0.5));
    t.speed_mps = cm(draw_.uniform(0.3, person ? 1.8 : 2.5));
    t.pause_s = std::round(draw_.uniform(0.0, 6.0));
    t.start_s = std::round(draw_.uniform(0.0, 10.0));
    t.motion = draw_.uniform() < 0.6 ? Motion::Back : Motion::Loop;
    t.reflect = reflect();
    // Across where the robot may drive, not through where it starts.
    const Vec2 from = place(1.0);
    t.points = {from};
    for (int i = 1 + draw_.below(2); i > 0; --i) t.points.push_back(place(1.0));
    world_.things.push_back(std::move(t));
  }

  Draw draw_;
  double around_m_;
  World world_;
};

}  // namespace

std::string_view to_string(RandomKind kind) noexcept {
  switch (kind) {
    case RandomKind::Static:
      return "static";
    case RandomKind::Moving:
      return "moving";
    case RandomKind::Grass:
      return "grass";
    case RandomKind::Crowded:
      return "crowded";
  }
  return "static";
}

World random_world(std::uint64_t seed, RandomKind kind) {
  return Maker(seed, kind).make(kind);
}

std::optional<World> random_world_named(std::string_view text) {
  constexpr std::string_view kWord = "random:";
  if (!text.starts_with(kWord)) return std::nullopt;
  text.remove_prefix(kWord.size());
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, seed);
  if (ec != std::errc{}) return std::nullopt;
  if (ptr == end) return random_world(seed, RandomKind::Static);
  for (const RandomKind kind : kAllKinds) {
    if (std::string_view(ptr, end) == ":" + std::string(to_string(kind))) {
      return random_world(seed, kind);
    }
  }
  return std::nullopt;
}

}  // namespace roverd::sim::world
