#pragma once
// What a robot is taken through in tests: what a parameter may change shows in one of these scenes.
// The change comes in the middle, or before what reads it begins.

#include <string>
#include <utility>
#include <vector>

#include "failsafe_scenes.hpp"
#include "ground_scenes.hpp"

namespace roverd::robot {

inline const std::vector<base::EnuPoint> kZigzag{{0, 6}, {3, 9}, {6, 9}, {6, 3}, {1, 3}};

inline mission::Plan bends() {
  mission::Plan plan = plan_of(kZigzag);
  for (auto& item : plan.items) std::get<mission::Waypoint>(item).turn = mission::Turn::Through;
  std::get<mission::Waypoint>(plan.items[3]).turn = mission::Turn::Auto;
  std::get<mission::Waypoint>(plan.items[4]).reverse = true;
  return plan;
}

inline mission::Plan with(mission::Plan plan, mission::Item item) {
  plan.items.insert(plan.items.begin() + 1, std::move(item));
  return plan;
}

inline void lay_yard(Walk& w, double half_m) {
  auto fence = std::make_shared<mission::Fence>();
  fence->name = "yard";
  mission::FencePolygon p;
  for (const base::EnuPoint c : {base::EnuPoint{-half_m, -half_m}, base::EnuPoint{half_m, -half_m},
                                 base::EnuPoint{half_m, half_m}, base::EnuPoint{-half_m, half_m}}) {
    p.points.push_back(kFrame.to_global(c));
  }
  fence->areas.push_back({mission::AreaKind::Inclusion, p});
  (void)w.ask(SetFence{w.robot.lay_fence(fence)});
}

/// The receiver does not know better than the odometry any more, and later nothing.
inline void fade(Walk& w) {
  w.fix = base::FixType::Single;
  w.fix_sigma_m = 2.9;
  w.run(8.0);
  w.gnss_speaks = false;
  w.run(30.0);
}

inline const std::vector<base::EnuPoint> kNorthwards{{0, 2}, {0, 5}, {0, 7}, {0, 9}, {0, 16}};

/// The mission waits, the robot is driven off its way by hand, and goes on from there.
inline void leave_and_resume(Walk& w) {
  w.run(8.0);
  w.go(plan_of(kNorthwards));
  w.run(6.0);
  w.change();
  (void)w.ask(SetMode{Mode::Manual});
  w.stick(0.0, -0.6, 2.8);
  w.stick(0.6, 0.0, 2.4);
  w.stick(0.0, 0.0, 0.5);
  (void)w.ask(SetMode{Mode::Hold});
  w.run(1.0);
  (void)w.ask(ResumeMission{});
}

// What the robot is taken through. The change comes in the middle, or before what reads it begins.
inline const std::vector<Scene> kDriveScenes = {
    {"a mission is driven",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of(kZigzag));
       w.run(2.0);
       w.change();
       w.run(35.0);
     }},
    {"a mission is loaded and driven",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       w.go(bends());
       w.run(30.0);
     }},
    {"pure pursuit",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of(kZigzag));
       w.run(1.0);
       w.change();
       w.run(12.0);
     },
     [](Config& c) { c.track.law = "pure_pursuit"; }},
    {"stanley",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of(kZigzag));
       w.run(1.0);
       w.change();
       w.run(12.0);
     },
     [](Config& c) { c.track.law = "stanley"; }},
    {"the start of the program",
     [](Walk& w) {
       w.run(0.1);
       w.change();
       w.satellites = 8;
       w.hdop = 1.5;
       w.fix_sigma_m = 1.0;
       w.speed_sigma_mps = 0.3;
       w.fix = base::FixType::RtkFloat;
       w.run(10.0);
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.8, 0.4, 8.0);
       w.stick(0.0, 0.0, 1.0);
     }},
    {"two antennas and a lean",
     [](Walk& w) {
       w.compass = base::HeadingSource::DualAntenna;
       w.more = [&w] { w.robot.measurements().put(base::Attitude{w.now, 0.15, 0.1}); };
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.8, 0.4, 8.0);
     }},
    {"currents turn the compass",
     [](Walk& w) {
       w.more = [&w] {
         const double a = 4.0 + 4.0 * std::abs(w.command.twist.linear_mps);
         w.robot.measurements().put(base::MotorState{w.now, 1, {}, a, {}, {}, {}, {}, {}});
         w.robot.measurements().put(base::MotorState{w.now, 2, {}, 0.5 * a, {}, {}, {}, {}, {}});
         w.robot.measurements().put(base::MotorState{w.now, 3, {}, 9.0, {}, {}, {}, {}, {}});
       };
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.8, 0.4, 8.0);
     },
     [](Config& c) {
       c.estimate.compass_left_deg_per_a = 0.5;
       c.estimate.compass_right_deg_per_a = -0.25;
     }},
    {"an anchor",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       (void)w.ask(SetAnchor{kFrame.to_global({3.0, 2.0}), {}});
       w.run(1.0);
     }},
    {"pushed off the path, and on again",
     [](Walk& w) {
       w.run(8.0);
       w.go(with(plan_of({{0, 6}, {0, 20}}), mission::Wait{1.0}));
       w.run(3.0);
       w.change();
       (void)w.ask(PauseMission{});
       w.at.east_m += 1.4;
       w.run(4.0);
       (void)w.ask(ResumeMission{});
       w.run(15.0);
       w.at.east_m += 4.5;
       w.run(20.0);
     }},
    {"off the way by hand, and on again",
     [](Walk& w) {
       leave_and_resume(w);
       w.run(15.0);
     }},
    {"beside the way, which it does not drive back to first",
     [](Walk& w) {
       leave_and_resume(w);
       w.run(15.0);
     },
     [](Config& c) { c.track.rejoin_m = 10.0; }},
    {"lost beside the way",
     [](Walk& w) {
       leave_and_resume(w);
       w.run(10.0);
     },
     [](Config& c) {
       c.track.rejoin_m = 10.0;
       c.behave.lost_m = 0.2;
     }},
    {"backwards",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       GoTo way;
       way.yaw_rad = 0.5 * base::kPi;
       way.speed_mps = -0.45;
       (void)w.ask(way);
       w.run(4.0);
     }},
    {"backwards to a goal",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       GoTo behind = w.to({0, -5});
       behind.reverse = true;
       (void)w.ask(behind);
       w.run(8.0);
     }},
    {"a place that a car cannot come to",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       w.go(plan_of({{0, 6}, {1.5, 7}, {1.5, 12}}));
       w.run(40.0);
     },
     [](Config& c) {
       c.vehicle.kinematics = "ackermann";
       c.vehicle.wheelbase_m = 1.0;
       c.vehicle.max_steering_deg = 25.0;
     }},
    {"stuck",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 6}, {4, 6}}));
       w.run(3.0);
       w.change();
       w.obeys = false;
       w.does = {0.02, 0.01};
       w.run(30.0);
     },
     [](Config& c) { c.safety.follow_timeout_s = 10.0; }},
    {"a stop beside its place",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 5}, {5, 5}}));
       w.run(1.0);
       w.change();
       w.more = [&w] {
         if (w.at.north_m > 3.8 && w.at.north_m < 5.5) w.at.east_m += 0.008;
       };
       w.run(25.0);
     }},
    {"a start from afar",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       w.go(plan_of({{0, 30}}));
       w.run(3.0);
     }},
    {"goals, moves and turns",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       (void)w.ask(w.to({4, 6}));
       w.run(10.0);
       (void)w.ask(w.to({12, 2}));
       w.run(20.0);
       MoveBy move;
       move.forward_m = 1.0;
       (void)w.ask(move);
       w.run(6.0);
       move.forward_m = -0.5;
       (void)w.ask(move);
       w.run(7.0);
       MoveBy turn;
       turn.turn_rad = 2.0;
       (void)w.ask(turn);
       w.run(10.0);
       GoTo way;
       way.yaw_rad = 0.4;
       way.speed_mps = 0.5;
       (void)w.ask(way);
       w.run(6.0);
     }},
    {"goals that are cut",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       (void)w.ask(w.to({8, 8}));
       w.run(1.0);
       w.change();
       w.run(25.0);
     },
     [](Config& c) { c.modes.goal_cut_m = 3.0; }},
    {"the driven way back",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.8, 0.2, 8.0);
       w.stick(0.8, -0.3, 6.0);
       (void)w.ask(SetMode{Mode::Hold});
       w.run(1.0);
       (void)w.ask(SetMode{Mode::SmartRtl});
       w.run(20.0);
     }},
    {"docking",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       GoTo pose = w.to({3, 4});
       pose.yaw_rad = 0.3;
       (void)w.ask(SetMode{Mode::Dock, pose});
       w.run(40.0);
     }},
    {"docking with a base that slips",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       GoTo pose = w.to({2, 4});
       pose.yaw_rad = 0.3;
       (void)w.ask(SetMode{Mode::Dock, pose});
       w.more = [&w] { w.yaw_rad += 0.0012; };
       w.run(40.0);
     }},
    {"following",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.target({1, 6}, {0.0, 0.5});
       (void)w.ask(SetMode{Mode::Follow});
       w.run(0.5);
       w.change();
       for (int i = 0; i < 16; ++i) {
         w.target({1.0, 6.0 + 0.25 * i}, {0.0, 0.5});
         w.run(0.48);
       }
       w.target({1, 24}, {0.0, 0.5});
       w.run(0.5);
       for (int i = 0; i < 10; ++i) {
         w.target({1.0, 10.2 - 0.35 * i}, {0.0, -0.7});
         w.run(0.48);
       }
       w.run(6.0);
     }},
    {"a target far away",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       w.target({1, 30}, {0.0, 0.5});
       (void)w.ask(SetMode{Mode::Follow});
       w.run(2.0);
     }},
    {"by hand, with help",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       w.more = [&w] { w.yaw_rad += 0.003; };
       for (const Mode mode : {Mode::Manual, Mode::Acro, Mode::Steering, Mode::Simple}) {
         (void)w.ask(SetMode{mode});
         w.stick(1.5, 0.9, 2.0);
         w.stick(0.8, 0.0, 2.0);
         w.stick(-0.5, -1.2, 1.0);
         w.run(1.0);
       }
     }},
    {"by hand over a late link",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.let_go();
       w.change();
       for (const double late_s : {0.1, 0.3, 0.4}) {
         for (double t = 0.0; t < 3.0; t += 0.1) {
           const Drive stick{{0.8, 0.0}, true, 1, w.now - base::from_seconds(late_s)};
           w.robot.request(stick, w.now + std::chrono::seconds(1), {});
           w.run(0.1);
         }
       }
     }},
    {"the base falls silent by parts",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       w.base_speaks = false;
       w.run(3.0);
       w.more = [&w] { w.robot.measurements().put(base::BaseMotion{w.now, {}}); };
       w.run(6.0);
     }},
    {"the base takes no commands",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.change();
       w.control_mode = base::ControlMode::Standby;
       w.run(8.0);
     }},
    {"the base never takes commands",
     [](Walk& w) {
       w.control_mode = base::ControlMode::Standby;
       w.run(8.0);
       w.change();
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.run(8.0);
     }},
    {"the base takes no commands while it drives",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 15}}));
       w.run(3.0);
       w.change();
       w.control_mode = base::ControlMode::Standby;
       w.run(8.0);
     }},
    {"the base does not move",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 15}}));
       w.run(3.0);
       w.change();
       w.obeys = false;
       w.does = {};
       w.run(6.0);
     }},
    {"the transmitter falls silent",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.run(1.0);
       w.change();
       w.radio_speaks = false;
       w.run(3.0);
     }},
    {"a bumper falls silent",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       w.robot.measurements().put(base::Bumper{w.now, false, {}});
       w.run(0.1);
       w.change();
       w.run(5.0);
     }},
    {"wheels spin in mud",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 15}}));
       w.run(4.0);
       w.change();
       w.grip = 0.0;
       w.run(8.0);
     }},
    {"wheels slip",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 15}}));
       w.run(4.0);
       w.change();
       w.more = [&w] { w.at.north_m -= 0.02 * w.command.twist.linear_mps; };
       w.run(8.0);
     }},
    {"the receiver jumps, and jumps again",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 45}}));
       w.run(3.0);
       w.change();
       w.receiver_off = {0.8, 0.0};
       w.run(16.0);
       w.receiver_off = {1.6, 0.0};
       w.run(18.0);
     }},
    {"the position fades",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 45}}));
       w.run(3.0);
       w.change();
       fade(w);
     },
     [](Config& c) { c.safety.gnss_hold_s = 60.0; }},
    {"the position grows uncertain",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 45}}));
       w.run(3.0);
       w.change();
       fade(w);
     },
     [](Config& c) {
       c.safety.gnss_hold_s = 60.0;
       c.safety.sigma_slow_m = 0.1;
       c.safety.sigma_hold_m = 0.3;
     }},
    {"the position is lost",
     [](Walk& w) {
       w.run(8.0);
       w.go(plan_of({{0, 45}}));
       w.run(3.0);
       w.change();
       w.gnss_speaks = false;
       w.run(12.0);
     }},
    {"the position is lost, with a gyro",
     [](Walk& w) {
       w.more = [&w] {
         base::Inertial m;
         m.stamp = w.now;
         m.rate_radps = base::BodyVector{0.0, 0.0, w.command.twist.angular_radps};
         w.robot.measurements().put(m);
       };
       w.run(8.0);
       w.go(plan_of({{0, 45}}));
       w.run(3.0);
       w.change();
       w.gnss_speaks = false;
       w.run(12.0);
     }},
    {"the battery runs down",
     [](Walk& w) {
       w.run(8.0);
       w.charge_pct = 30.0;
       (void)w.ask(Arm{});
       w.change();
       for (const double pct : {25.0, 15.0, 7.0}) {
         w.charge_pct = pct;
         w.run(0.5);
       }
     }},
    {"armed a second time, elsewhere",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.change();
       w.stick(0.8, 0.0, 6.0);
       (void)w.ask(Disarm{});
       (void)w.ask(Arm{});
       w.stick(0.8, 0.5, 4.0);
       (void)w.ask(SetMode{Mode::Rtl});
       w.run(15.0);
     }},
    {"armed a second time, after it stood",
     [](Walk& w) {
       w.run(8.0);
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.stick(0.8, 0.0, 6.0);
       w.stick(0.0, 0.0, 1.0);
       (void)w.ask(Disarm{});
       w.run(2.0);
       w.change();
       (void)w.ask(Arm{});
       w.run(1.0);
     }},
    {"a voltage",
     [](Walk& w) {
       w.battery_v = 48.0;
       w.run(8.0);
       w.change();
       w.run(1.0);
     }},
    {"by hand to the fence",
     [](Walk& w) {
       w.run(8.0);
       lay_yard(w, 6.0);
       (void)w.ask(Arm{});
       (void)w.ask(SetMode{Mode::Manual});
       w.change();
       w.stick(0.8, 0.0, 12.0);
     }},
    {"switches are thrown",
     [](Walk& w) {
       w.run(8.0);
       w.change();
       const auto thrown = [&w](base::Switch& s, base::Switch to, double seconds) {
         s = to;
         w.run(seconds);
       };
       for (const double vra : {-0.9, -0.2, 0.3, 0.9}) {
         w.vra = vra;
         thrown(w.swa, base::Switch::Down, 0.3);
         thrown(w.swa, base::Switch::Up, 0.3);
       }
       thrown(w.swd, base::Switch::Down, 0.3);
       thrown(w.swc, base::Switch::Middle, 0.3);
       thrown(w.swc, base::Switch::Down, 0.3);
       thrown(w.swc, base::Switch::Up, 0.06);
       thrown(w.swc, base::Switch::Down, 0.3);
       thrown(w.swc, base::Switch::Up, 0.3);
       thrown(w.swd, base::Switch::Up, 0.3);
       w.swb = base::Switch::Down;
       thrown(w.swa, base::Switch::Down, 0.3);
     }},
};

inline const std::vector<Scene> kScenes =
    joined(joined(kDriveScenes, kGroundScenes), kFailsafeScenes);

}  // namespace roverd::robot
