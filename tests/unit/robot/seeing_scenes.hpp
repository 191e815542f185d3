#pragma once
// Scenes of a robot that sees: what the guard's parameters may change shows in one of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "failsafe_scenes.hpp"
#include "robot/guard/around.hpp"
#include "robot/guard/lookout.hpp"

namespace roverd::robot {

/// What stands around the robot, where it began: x ahead, y to the left, metres.
struct Around {
  struct Box {
    double x0_m, x1_m, y0_m, y1_m;
  };
  std::vector<Box> boxes;
  std::vector<nav::sense::Mover> movers;  ///< where they were at `seen`
  nav::sense::Known ground = nav::sense::Known::Free;
  bool sees = true;
  nav::sense::Pose2 pose;
  int ticks = 0;

  std::shared_ptr<Surroundings> seen_at(base::Time now) const {
    static constexpr std::int32_t kSide = 280;
    auto s = std::make_shared<Surroundings>();
    nav::sense::Patch& patch = s->patch;
    patch.stamp = now;
    patch.side = kSide;
    patch.x0 = static_cast<std::int32_t>(std::floor(pose.x_m / 0.05)) - kSide / 2;
    patch.y0 = static_cast<std::int32_t>(std::floor(pose.y_m / 0.05)) - kSide / 2;
    patch.cells.assign(static_cast<std::size_t>(kSide * kSide), {ground, 0, 0});
    const auto cell = [](double m, std::int32_t first) {
      return std::clamp(static_cast<std::int32_t>(std::floor(m / 0.05)) - first, 0, kSide);
    };
    for (const Box& b : boxes) {
      for (std::int32_t y = cell(b.y0_m, patch.y0); y < cell(b.y1_m, patch.y0); ++y) {
        for (std::int32_t x = cell(b.x0_m, patch.x0); x < cell(b.x1_m, patch.x0); ++x) {
          patch.cells[static_cast<std::size_t>(y * kSide + x)].known = nav::sense::Known::Occupied;
        }
      }
    }
    for (nav::sense::Mover m : movers) {
      m.at = m.at + base::seconds(now - m.seen) * m.v_mps;
      m.seen = now;
      s->movers.push_back(m);
    }
    base::SensorState state;
    state.name = "front";
    state.kind = "velodyne";
    state.required = true;
    state.health = sees ? base::SensorHealth::Good : base::SensorHealth::Silent;
    if (sees) state.seen = s->seen = now;
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
    return s;
  }
};

inline void guard_as_configured(Walk& w) {
  const auto c = w.robot.config();
  w.robot.guard_by(c->protect, true, c->blocked, {}, c->rays);
}

/// Ten pictures a second of what stands around it; who asks for a way around is told that there is
/// none.
inline std::shared_ptr<Around> see(Walk& w) {
  auto around = std::make_shared<Around>();
  guard_as_configured(w);
  w.more = [&w, around] {
    std::vector<nav::sense::Odometry> moved;
    w.robot.odometry().take(moved);
    for (const auto& o : moved) around->pose = o.pose;
    if (around->ticks++ % 5 == 0) w.robot.surroundings().put(around->seen_at(w.now));
    std::vector<std::shared_ptr<const AroundQuestion>> asked;
    w.robot.around_questions().take(asked);
    if (asked.empty()) return;
    auto answer = std::make_shared<AroundAnswer>();
    answer->asked = asked.back();
    answer->refused = "nobody looks for one here";
    w.robot.around_answers().put(std::move(answer));
  };
  return around;
}

/// A scanner 0.6 m ahead of the body's middle that meets two posts, 6 to 12 degrees to either side
/// of straight ahead, the inner edge of each the nearest: 6 m ahead of where the robot began.
inline void scan(Walk& w) {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 10.0;
  nav::sense::ChainParams chain;
  chain.reduce.voxel_m = 0.01;  // a beam a voxel
  const auto begun = w.robot.config();
  auto eyes = std::make_shared<Lookout>(
      *nav::sense::Chain::of(chain, {eye}, footprint_of({}), w.now),
      std::vector<std::string>{"sick"}, begun->protect.reach_m, begun->rays);
  guard_as_configured(w);
  w.more = [&w, eyes, x_m = 0.0, ticks = 0]() mutable {
    std::vector<nav::sense::Odometry> moved;
    w.robot.odometry().take(moved);
    for (const auto& o : moved) {
      eyes->moved(o);
      x_m = o.pose.x_m;
    }
    if (ticks++ % 5 != 0 || moved.empty()) return;
    const auto now = w.robot.config();
    eyes->follow(now->protect, now->rays);
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "front";
    sight->stamp = moved.back().stamp;
    sight->count = static_cast<std::uint64_t>(ticks);
    sight->half_step_rad = 0.009F;
    sight->clear_to_m = 8.0F;
    const double post_m = 6.0 - x_m - 0.6;
    for (int i = -90; i <= 90; ++i) {
      const double bearing = base::rad_from_deg(i);
      const double r = post_m / std::cos(bearing) + 0.05 * (std::abs(i) - 6);
      const bool hit = std::abs(i) >= 6 && std::abs(i) <= 12 && r > 0.05 && r < 8.0;
      const double at_m = hit ? r : 8.0;
      sight->points.push_back({static_cast<float>(at_m * std::cos(bearing)),
                               static_cast<float>(at_m * std::sin(bearing)), 0.0F, 0.0F, 0, 0,
                               hit ? base::Echo::Hit : base::Echo::Clear});
    }
    eyes->see(std::move(sight), w.now);
    if (auto picture = eyes->picture(w.now)) w.robot.surroundings().put(std::move(picture));
  };
}

inline void drive_scanning(Walk& w) {
  scan(w);
  w.run(8.0);
  w.go(plan_of({{0, 1}, {0, 20}}));
  w.run(2.0);
  w.change();
  w.run(12.0);
}

inline const std::vector<Scene> kSeeingScenes = {
    {"towards a wall that goes away",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       w.go(plan_of({{0, 1}, {0, 20}}));
       w.run(1.0);
       w.change();
       around->boxes = {{7.0, 8.0, -50.0, 50.0}};
       w.run(20.0);
       around->boxes.clear();
       w.run(6.0);
     },
     [](Config& c) {
       c.speed.default_mps = c.speed.max_mps = 1.3;
       c.vehicle.max_speed_mps = 1.3;
     }},
    {"past a wall beside the way",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       around->boxes = {{3.0, 6.0, 0.75, 3.0}};
       w.change();
       w.go(plan_of({{0, 1}, {0, 20}}));
       w.run(15.0);
     }},
    {"people cross its way one after the other",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       w.go(plan_of({{0, 1}, {0, 20}}));
       w.run(1.0);
       w.change();
       for (const double behind_m : {3.0, 6.0, 9.0, 13.0}) {
         nav::sense::Mover m;
         m.at = {0.5 + behind_m, -1.1 * behind_m};
         m.v_mps = {0.0, 0.8};
         m.seen = w.now;
         around->movers.push_back(m);
       }
       w.run(20.0);
       // From the side, too near to be stood before: it passes, with room or without.
       nav::sense::Mover beside;
       beside.at = {around->pose.x_m - 0.2, around->pose.y_m - 1.5};
       beside.v_mps = {0.0, 0.5};
       beside.seen = w.now;
       around->movers = {beside};
       w.run(4.0);
     }},
    {"a turn beside a wall",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       (void)w.ask(Arm{});
       around->boxes = {{-1.0, 1.0, 0.55, 1.0}};
       w.change();
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.0, 0.7, 4.0);
     }},
    {"where nobody has seen",
     [](Walk& w) {
       const auto around = see(w);
       around->ground = nav::sense::Known::Unknown;
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       MoveBy move;
       move.forward_m = 1.0;
       (void)w.ask(move);
       w.run(6.0);
       move.forward_m = -0.5;
       (void)w.ask(move);
       w.run(4.0);
       MoveBy turn;
       turn.turn_rad = 1.0;
       (void)w.ask(turn);
       w.run(4.0);
     }},
    {"a hand that holds the guard off",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       (void)w.ask(Arm{});
       around->boxes = {{1.2, 2.0, -2.0, 2.0}};
       w.change();
       (void)w.ask(SetMode{Mode::Manual});
       w.let_go();
       for (double t = 0.0; t < 4.0; t += 0.1) {
         Drive stick{{0.6, 0.0}, true};
         stick.override_guard = true;
         w.robot.request(stick, w.now + std::chrono::milliseconds(250), {});
         w.run(0.1);
       }
     }},
    {"a dock that stands there",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       (void)w.ask(Arm{});
       around->boxes = {{4.6, 4.8, -0.5, 0.5}};
       w.change();
       GoTo pose = w.to({0, 4});
       pose.yaw_rad = 0.5 * base::kPi;
       (void)w.ask(SetMode{Mode::Dock, pose});
       w.run(25.0);
     }},
    {"a way around is looked for",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       w.go(plan_of({{0, 1}, {0, 20}}));
       w.run(3.0);
       w.change();
       around->boxes = {{5.0, 5.4, -0.6, 0.6}};
       w.run(12.0);
     },
     [](Config& c) {
       c.blocked.then = "around";
       c.blocked.after_s = 6.0;
     }},
    {"a sensor falls silent and sees again",
     [](Walk& w) {
       const auto around = see(w);
       w.run(8.0);
       w.go(plan_of({{0, 1}, {0, 20}}));
       w.run(3.0);
       w.change();
       around->sees = false;
       w.run(1.0);
       around->sees = true;
       w.run(10.0);
     }},
    {"rays that are not counted yet", drive_scanning,
     [](Config& c) {
       c.protect.creep_mps = 1.0;  // beside it nothing is seen
     }},
    {"counted rays beside the sweep", drive_scanning,
     [](Config& c) {
       c.rays.enabled = true;
       c.rays.slow_m = 0.0;        // else it slows before the sweep would
       c.protect.creep_mps = 1.0;  // beside it nothing is seen
     }},
    {"counted rays alone", drive_scanning,
     [](Config& c) { c.rays.enabled = c.rays.instead = true; }},
};

}  // namespace roverd::robot
