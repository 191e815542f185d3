// What is driven, where and in which weather: all of it from a number.

#include <charconv>
#include <cmath>
#include <numbers>

#include "base/angle.hpp"
#include "sim/world/draw.hpp"
#include "sim/world/random.hpp"
#include "sim/world/scene.hpp"
#include "study/world/worlds.hpp"

namespace roverd::study {
namespace {

using base::Result;
using sim::world::Draw;

constexpr int kMostWorlds = 100'000;
constexpr std::uint64_t kScenario = 15;
constexpr double kSpeeds_mps[] = {0.5, 1.0, 1.3};
constexpr double kOpen_s = 120.0;
constexpr double kAround_s = 180.0;
constexpr double kStraight_m = 16.0;  // with something on it,
constexpr double kClutter_m = 4.0;    // and so far beside it

std::vector<Course> usual_courses() {
  const auto course = [](std::string name, std::vector<base::EnuPoint> points) {
    Course c;
    c.name = std::move(name);
    c.points = std::move(points);
    return c;
  };
  return {course("straight", {{0, 0}, {0, 20}}), course("L", {{0, 0}, {0, 10}, {10, 10}}),
          course("slalom", {{0, 0}, {3, 4}, {-3, 8}, {3, 12}, {-3, 16}, {0, 20}})};
}

/// Turned about the start, so that it goes through another part of the world.
void turn(Course& course, double by_rad) {
  const double c = std::cos(by_rad);
  const double s = std::sin(by_rad);
  for (base::EnuPoint& p : course.points) {
    p = {c * p.east_m - s * p.north_m, s * p.east_m + c * p.north_m};
  }
}

/// Nearer together, so that a drive of a minute meets something; around the start nothing stands.
void draw_in(sim::world::World& world, double share) {
  constexpr double kFree_m = 2.2;
  std::erase_if(world.things, [&](sim::world::Thing& t) {
    for (auto& p : t.points) p = {share * p.x, share * p.y};
    const double half_m = std::hypot(t.length_m, t.width_m) / 2.0 + t.radius_m + t.thickness_m;
    for (std::size_t i = 0; i < t.points.size(); ++i) {
      const auto& a = t.points[i];
      const auto& b = t.points[i + 1 < t.points.size() ? i + 1 : i];
      for (int k = 0; k <= 20; ++k) {
        const double u = k / 20.0;
        const double x = std::lerp(a.x, b.x, u);
        const double y = std::lerp(a.y, b.y, u);
        if (std::hypot(x, y) < kFree_m + half_m) return true;
      }
    }
    return false;
  });
}

void choose_fault(Scenario& out, Draw& draw) {
  using Set = void (*)(sim::world::SensorFaults&, Draw&);
  struct Fault {
    const char* name;
    Set set;
  };
  static constexpr Fault kFaults[] = {
      {"rain", [](auto& f, Draw& d) { f.rain_per_m = d.uniform(0.001, 0.01); }},
      {"dust", [](auto& f, Draw& d) { f.dust_per_m = d.uniform(0.005, 0.05); }},
      {"dropouts", [](auto& f, Draw& d) { f.sensor_dropout = d.uniform(0.05, 0.4); }},
      {"sun",
       [](auto& f, Draw& d) {
         f.sun_heading_deg = d.uniform(0.0, 360.0);
         f.sun_elevation_deg = d.uniform(0.0, 12.0);
         f.sun_width_deg = d.uniform(10.0, 40.0);
       }},
      {"dirt",
       [](auto& f, Draw& d) {
         f.dirt_from_deg = d.uniform(-120.0, 60.0);
         f.dirt_to_deg = f.dirt_from_deg + d.uniform(5.0, 60.0);
         f.dirt_share = d.uniform() < 0.3 ? 1.0 : d.uniform(0.1, 0.9);
       }},
      {"noise", [](auto& f, Draw& d) { f.sensor_noise_m = d.uniform(0.01, 0.05); }},
      {"dead",
       [](auto& f, Draw& d) {
         f.sensor = d.uniform() < 0.5 ? "front" : "back";
         f.sensor_silent = true;
       }},
  };
  const Fault& one = kFaults[draw.below(static_cast<int>(std::size(kFaults)))];
  out.fault = one.name;
  one.set(out.faults, draw);
  if (out.fault == "dead" && out.lidar && out.faults.sensor == "back") out.faults.sensor = "top";
  out.fault_after_s = draw.uniform(0.0, 12.0);
}

/// Somewhere on the course, and which way it goes there.
struct OnCourse {
  base::EnuPoint at;
  double yaw_rad = 0.0;
};
OnCourse on_course(const Course& course, double s_m) {
  for (std::size_t i = 1; i < course.points.size(); ++i) {
    const base::EnuPoint leg = course.points[i] - course.points[i - 1];
    const double long_m = std::hypot(leg.east_m, leg.north_m);
    if (s_m > long_m && i + 1 < course.points.size()) {
      s_m -= long_m;
      continue;
    }
    const double part = long_m > 0.0 ? std::min(1.0, s_m / long_m) : 0.0;
    return {{course.points[i - 1].east_m + part * leg.east_m,
             course.points[i - 1].north_m + part * leg.north_m},
            std::atan2(leg.north_m, leg.east_m)};
  }
  return {};
}

/// Of the world only some things that stand.
void empty_of_people(sim::world::World& world) {
  std::erase_if(world.things, [](const auto& t) { return sim::world::moves(t.kind); });
  if (world.things.size() > 8) world.things.resize(8);
}

sim::world::Thing person(Draw& draw, double slowest_mps, double longest_pause_s) {
  sim::world::Thing t;
  t.kind = sim::world::Kind::Person;
  t.height_m = draw.uniform(1.1, 1.95);
  t.length_m = 0.3;
  t.width_m = draw.uniform(0.35, 0.55);
  t.speed_mps = draw.uniform(slowest_mps, 2.0);
  t.pause_s = draw.uniform(0.0, longest_pause_s);
  t.start_s = draw.uniform(0.0, 6.0);
  t.motion = sim::world::Motion::Back;
  return t;
}

/// To and fro across it: who meets the robot is a matter of chance.
void cross(sim::world::World& world, const Course& course, Draw& draw) {
  empty_of_people(world);
  for (int i = 2 + draw.below(3); i > 0; --i) {
    const OnCourse there = on_course(course, draw.uniform(3.5, 17.0));
    const double yaw = there.yaw_rad + draw.uniform(0.9, std::numbers::pi - 0.9);
    const double half_m = draw.uniform(3.0, 6.0);
    const double dx = half_m * std::cos(yaw);
    const double dy = half_m * std::sin(yaw);
    sim::world::Thing t = person(draw, 0.5, 4.0);
    t.points = {{there.at.east_m - dx, there.at.north_m - dy},
                {there.at.east_m + dx, there.at.north_m + dy}};
    world.things.push_back(std::move(t));
  }
}

/// Here and there about it, with corners of up to a right angle: who walks past may turn.
void wander(sim::world::World& world, const Course& course, Draw& draw) {
  empty_of_people(world);
  for (int i = 3 + draw.below(3); i > 0; --i) {
    const OnCourse there = on_course(course, draw.uniform(4.0, 17.0));
    const double off_rad = draw.uniform(-std::numbers::pi, std::numbers::pi);
    const double off_m = draw.uniform(1.0, 4.0);
    sim::world::Vec2 at{there.at.east_m + off_m * std::cos(off_rad),
                        there.at.north_m + off_m * std::sin(off_rad)};
    double yaw_rad = draw.uniform(-std::numbers::pi, std::numbers::pi);
    sim::world::Thing t = person(draw, 0.8, 1.0);
    t.pause_s += 1.0;  // before he turns back
    t.points = {at};
    for (int leg = 6 + draw.below(5); leg > 0; --leg) {
      const double leg_m = draw.uniform(1.0, 4.0);
      at = {at.x + leg_m * std::cos(yaw_rad), at.y + leg_m * std::sin(yaw_rad)};
      t.points.push_back(at);
      // He stays about there, and where he would leave he turns back more often than not.
      const double home_rad = std::atan2(there.at.north_m - at.y, there.at.east_m - at.x);
      const double side = base::angle_diff_rad(yaw_rad, home_rad) > 0.0 ? 1.0 : -1.0;
      yaw_rad += (draw.uniform() < 0.8 ? side : -side) * draw.uniform(0.3, 0.5 * std::numbers::pi);
    }
    world.things.push_back(std::move(t));
  }
}

/// Anything that stands, and that each sensor can see.
sim::world::Thing standing(Draw& draw, sim::world::Vec2 at) {
  using sim::world::Kind;
  sim::world::Thing t;
  t.height_m = draw.uniform(0.7, 2.0);
  t.points = {at};
  switch (draw.below(4)) {
    case 0:
      t.kind = Kind::Pole;
      t.radius_m = draw.uniform(0.04, 0.25);
      break;
    case 1: {
      t.kind = Kind::Wall;
      t.thickness_m = draw.uniform(0.05, 0.3);
      const double yaw = draw.uniform(0.0, std::numbers::pi);
      const double long_m = draw.uniform(0.5, 3.0);
      t.points.push_back({at.x + long_m * std::cos(yaw), at.y + long_m * std::sin(yaw)});
      break;
    }
    default:
      t.kind = Kind::Box;
      t.length_m = draw.uniform(0.3, 2.0);
      t.width_m = draw.uniform(0.3, 1.2);
      t.yaw_rad = draw.uniform(0.0, std::numbers::pi);
  }
  return t;
}

/// Something on the way, and other things anywhere but where it begins; a wall may reach its end.
void stand_on(Scenario& out, Draw& draw) {
  out.course = {};
  out.course.name = "straight";
  out.course.points = {{0, 0}, {0, kStraight_m}};
  const int others = draw.below(9);
  for (int i = 0; i <= others; ++i) {
    const bool first = i == 0;
    const double ahead_m = first ? draw.uniform(5.0, 10.0) : draw.uniform(4.0, kStraight_m - 3.0);
    const double aside_m = first ? draw.uniform(-0.6, 0.6) : draw.uniform(-kClutter_m, kClutter_m);
    out.world.things.push_back(standing(draw, {aside_m, ahead_m}));
  }
  out.kind = out.world.name = "around";
  out.around_late_s = draw.uniform(0.0, 0.6);
  out.time_s = kAround_s;
  out.sticks = false;
}

bool read_number(std::string_view& text, std::uint64_t& out) {
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (ec != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

}  // namespace

Result<WorldOrder> parse_worlds(std::string_view text) {
  WorldOrder out;
  for (const auto& [word, kind] :
       {std::pair{std::string_view("random:"), WorldOrder::Kind::Random},
        std::pair{std::string_view("open:"), WorldOrder::Kind::Open},
        std::pair{std::string_view("crossing:"), WorldOrder::Kind::Crossing},
        std::pair{std::string_view("turning:"), WorldOrder::Kind::Turning},
        std::pair{std::string_view("around:"), WorldOrder::Kind::Around}}) {
    if (!text.starts_with(word)) continue;
    out.kind = kind;
    std::string_view rest = text.substr(word.size());
    const std::string form = std::string(word) + "N or " + std::string(word) + "N:SEED";
    std::uint64_t count = 0;
    const bool counts = read_number(rest, count);
    const bool seeds = !rest.empty() && rest.front() == ':';
    if (seeds) rest.remove_prefix(1);
    if (!counts || (seeds && !read_number(rest, out.seed)) || !rest.empty()) {
      return base::fail(base::Code::Invalid, "--world " + std::string(text) + " must be " + form);
    }
    if (count < 1 || count > kMostWorlds) {
      return base::fail(base::Code::Invalid, "N of --world " + form + " must lie in 1 .. 100000");
    }
    out.count = static_cast<int>(count);
    return out;
  }
  if (text.empty()) return base::fail(base::Code::Invalid, "--world needs a file or random:N");
  out.file = text;
  return out;
}

Result<Scenario> scenario_of(const WorldOrder& order, std::uint64_t number,
                             const std::vector<Course>& courses, const sim::world::World& world) {
  using sim::world::RandomKind;
  Draw draw(number, kScenario + static_cast<std::uint64_t>(order.kind));
  Scenario out;
  out.number = number;
  out.fault = "none";
  const std::vector<Course> all = courses.empty() ? usual_courses() : courses;
  out.course = all[static_cast<std::size_t>(draw.below(static_cast<int>(all.size())))];
  if (out.course.points.size() < 2) {
    return base::fail(base::Code::Invalid,
                      "the course " + out.course.name + " has no points to drive in a world");
  }
  out.speed_mps = kSpeeds_mps[draw.below(3)];
  out.lidar = draw.uniform() < 0.25;
  const double how = draw.uniform();
  out.sticks = how < 0.35;
  out.course.reverse = how > 0.75;
  switch (order.kind) {
    case WorldOrder::Kind::File:
      out.world = world;
      out.kind = world.name.empty() ? "file" : world.name;
      break;
    case WorldOrder::Kind::Random:
      out.kind = draw.uniform() < 0.6 ? "static" : "moving";
      out.world =
          random_world(number, out.kind == "static" ? RandomKind::Static : RandomKind::Moving);
      if (draw.uniform() < 0.7) draw_in(out.world, draw.uniform(0.35, 0.6));
      if (draw.uniform() < 0.4) choose_fault(out, draw);
      break;
    case WorldOrder::Kind::Open:
      out.kind = "open";
      out.world = random_world(number, RandomKind::Grass);
      out.fault = "rain";
      out.faults.rain_per_m = draw.uniform(0.001, 0.01);
      out.fault_after_s = 0.0;
      out.time_s = kOpen_s;
      out.sticks = out.course.reverse = false;
      out.lidar = true;  // a plane meets every hill
      out.speed_mps = std::max(1.0, out.speed_mps);
      break;
    case WorldOrder::Kind::Around:
      break;  // below
    case WorldOrder::Kind::Crossing:
      out.kind = "crossing";
      out.world = random_world(number, RandomKind::Moving);
      break;
    case WorldOrder::Kind::Turning:
      out.kind = "turning";
      out.world = random_world(number, RandomKind::Moving);
      break;
  }
  if (order.kind == WorldOrder::Kind::Around) {
    stand_on(out, draw);
    if (draw.uniform() < 0.3) {
      out.fault = "noise";
      out.faults.sensor_noise_m = draw.uniform(0.01, 0.04);
      out.fault_after_s = 0.0;
    }
  } else if (order.kind != WorldOrder::Kind::File) {
    turn(out.course, 2.0 * std::numbers::pi * draw.uniform());
  }
  if (order.kind == WorldOrder::Kind::Crossing) cross(out.world, out.course, draw);
  if (order.kind == WorldOrder::Kind::Turning) wander(out.world, out.course, draw);
  if (order.kind == WorldOrder::Kind::Open) {
    // Longer: to and fro.
    const auto once = out.course.points;
    for (int i = 0; i < 5; ++i) {
      const bool back = i % 2 == 0;
      for (std::size_t k = 1; k < once.size(); ++k) {
        out.course.points.push_back(once[back ? once.size() - 1 - k : k]);
      }
    }
  }
  out.course.speed_mps = out.speed_mps;
  return out;
}

}  // namespace roverd::study
